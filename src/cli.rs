//! The command line: arguments to [`Settings`] and a [`Command`], and back.
//!
//! Two kinds of mistake are told apart. What cannot be read as arguments at all (an unknown
//! option, a size that is no size, `--eye` without `--target`) is *wrong usage*: clap's message,
//! exit code 2. What reads well but names nothing or lies out of range is *bad input*
//! ([`InputError`]): one line, exit code 1, like a file that cannot be opened.
//!
//! [`render_command`] goes the other way: settings to the command line that draws them again,
//! which pictures carry and the window copies to the clipboard.

mod bench;
mod command_line;
mod complexity;
mod counting;
mod csg;
mod culling;
mod decals;
mod diagram;
mod dissolve;
mod halo;
mod input;
mod light_edit;
mod lighting;
mod mirrors;
mod picture;
mod planar;
mod playground;
mod silhouettes;
mod verify;

pub use bench::{BenchRequest, DEFAULT_FRAMES, Sweep, SweepRequest};
pub use command_line::render_command;
pub use input::{InputError, MAX_COORDINATE, MAX_EXPOSURE, check, check_against};
pub use verify::{RANDOM_SIZE, VerifyRequest};

use std::ffi::{OsStr, OsString};
use std::path::PathBuf;
use std::str::FromStr;

use clap::error::ErrorKind;
use clap::{Args, CommandFactory as _, Parser, Subcommand};
use glam::DVec3;

use crate::figures::{self, Figure};
use crate::scene::{AnimationChoice, stock};
use crate::settings::{Api, MAX_SIZE, SceneChoice, Settings};

/// What the arguments ask for.
#[derive(Debug, Clone, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "there is one, once")]
pub enum Command {
    /// Opens the window.
    Window(Box<WindowRequest>),
    /// Draws one picture.
    Render {
        /// What is drawn.
        settings: Settings,
        /// The PNG file to write.
        out: PathBuf,
        /// Prints what was done as JSON.
        json: bool,
    },
    /// Holds what techniques draw against exact rays.
    Verify {
        /// What is drawn and asked.
        request: Box<VerifyRequest>,
        /// Prints what was found as JSON.
        json: bool,
    },
    /// Measures frames.
    Bench {
        /// What is drawn, and how often.
        request: BenchRequest,
        /// Prints what was measured as JSON.
        json: bool,
    },
    /// Measures how the cost of frames grows.
    Sweep {
        /// With what, and where to write it.
        request: Box<SweepRequest>,
        /// Prints what was measured as JSON.
        json: bool,
    },
    /// Draws a board of the playground, or prints its calls.
    Playground {
        /// What is drawn.
        settings: Settings,
        /// The PNG file to write.
        out: Option<PathBuf>,
        /// Whose calls are printed.
        calls: Option<Api>,
    },
    /// Names scenes, techniques and shows.
    List {
        /// As JSON.
        json: bool,
    },
    /// Prints what was imported.
    Info {
        /// Which scene.
        scene: SceneChoice,
        /// With a floor beneath it.
        floor: bool,
        /// As JSON.
        json: bool,
    },
    /// Draws the papers' figures.
    Figures {
        /// Which, in the order of the table.
        figures: Vec<&'static Figure>,
        /// Pixels.
        size: [u32; 2],
        /// The folder to write to; made where it is missing.
        out: PathBuf,
    },
    /// Draws every stock scene in every mode.
    Tour {
        /// The folder to write to; made where it is missing.
        out: PathBuf,
    },
}

/// What the arguments say about the window, apart from what its last run left.
#[derive(Debug, Clone, PartialEq)]
pub struct WindowRequest {
    arguments: WindowArguments,
    /// Whether frames wait for the screen, where the arguments say.
    pub vsync: Option<bool>,
    /// The window closes after this many frames.
    pub frames: Option<u64>,
    /// No argument was given at all.
    pub bare: bool,
}

impl WindowRequest {
    /// The settings to start with. Arguments win over `saved`; where they name a scene, what
    /// `saved` says about another scene's lights, cameras and animations is left out.
    ///
    /// # Errors
    /// Arguments that name nothing or lie out of range.
    pub fn settings(&self, saved: Settings) -> Result<Settings, InputError> {
        self.arguments.picture.settings(self.arguments.scene.as_deref(), saved)
    }

    /// Whether the arguments say which scene: then it is theirs, and not the last run's.
    #[must_use]
    pub fn names_scene(&self) -> bool {
        self.arguments.scene.is_some()
    }
}

/// Reads the process's arguments, the program's name first.
///
/// # Errors
/// Clap's error for wrong usage, `--help` and `--version`; it knows its exit code.
pub fn parse<A: Into<OsString> + Clone>(arguments: impl IntoIterator<Item = A>) -> Result<Parsed, clap::Error> {
    let arguments: Vec<OsString> = arguments.into_iter().map(Into::into).collect();
    let bare = arguments.len() < 2;
    let cli = Cli::try_parse_from(arguments)?;
    let picture = match &cli.command {
        None => &cli.window.picture,
        Some(Subcommands::Render(render)) => &render.picture,
        Some(Subcommands::Verify(verify)) => &verify.picture,
        Some(Subcommands::Bench(bench)) => &bench.picture,
        Some(_) => return Ok(Parsed { cli, bare }),
    };
    if let (Some(Subcommands::Verify(_)), Some(_)) = (&cli.command, &picture.show) {
        let words = "verify always draws `--show shadow`: leave --show out";
        return Err(Cli::command().error(ErrorKind::ArgumentConflict, words));
    }
    match (picture.eye, picture.target) {
        (Some(_), None) => Err(Cli::command().error(ErrorKind::MissingRequiredArgument, "--eye needs --target <X,Y,Z>")),
        (None, Some(_)) => Err(Cli::command().error(ErrorKind::MissingRequiredArgument, "--target needs --eye <X,Y,Z>")),
        _ => Ok(Parsed { cli, bare }),
    }
}

/// Arguments that read well; [`Parsed::command`] says whether they also mean something.
#[derive(Debug)]
pub struct Parsed {
    cli: Cli,
    bare: bool,
}

impl Parsed {
    /// What is to be done.
    ///
    /// # Errors
    /// Arguments that name nothing or lie out of range.
    pub fn command(self) -> Result<Command, InputError> {
        Ok(match self.cli.command {
            None => {
                let arguments = self.cli.window;
                let (vsync, frames) = (arguments.vsync.map(|switch| switch == Switch::On), arguments.frames);
                let request = WindowRequest { arguments, vsync, frames, bare: self.bare };
                request.settings(Settings::default())?;
                Command::Window(Box::new(request))
            }
            Some(Subcommands::Render(render)) => Command::Render {
                settings: render.picture.settings(render.scene.as_deref(), Settings::default())?,
                out: render.out,
                json: render.json,
            },
            Some(Subcommands::Verify(verify)) => {
                let json = verify.json;
                Command::Verify { request: Box::new(verify.request()?), json }
            }
            Some(Subcommands::Bench(bench)) => {
                let json = bench.json;
                match bench.sweep_request()? {
                    Some(request) => Command::Sweep { request: Box::new(request), json },
                    None => Command::Bench { request: bench.request()?, json },
                }
            }
            Some(Subcommands::Playground(playground)) => playground.request()?,
            Some(Subcommands::List { json }) => Command::List { json },
            Some(Subcommands::Info { scene, floor, json }) => Command::Info { scene: scene_choice(&scene)?, floor, json },
            Some(Subcommands::Tour { out }) => Command::Tour { out },
            Some(Subcommands::Figures { names, out, size }) => {
                let (figures, size) = (figures_named(&names)?, size.unwrap_or(FIGURE_SIZE));
                check(&Settings { size, ..Settings::default() })?;
                Command::Figures { figures, size, out }
            }
        })
    }
}

/// A stock scene's name, or else a path. `./name` is always the file.
///
/// # Errors
/// An empty word.
pub fn scene_choice(word: &OsStr) -> Result<SceneChoice, InputError> {
    let Some(text) = word.to_str() else { return Ok(SceneChoice::File(word.into())) };
    if text.is_empty() {
        return Err(InputError::Empty("the scene's name"));
    }
    if is_stock(text) {
        return Ok(SceneChoice::Stock(text.into()));
    }
    // The `./` that only keeps a name from being taken for something else is not part of the path.
    let bare = text.strip_prefix("./").filter(|rest| needs_dot(rest));
    Ok(SceneChoice::File(bare.unwrap_or(text).into()))
}

/// The size of a figure, pixels, where nothing is said.
const FIGURE_SIZE: [u32; 2] = [1280, 720];

/// The figures whose names begin with one of these; all of them for none.
fn figures_named(names: &[String]) -> Result<Vec<&'static Figure>, InputError> {
    let begins = |figure: &Figure, name: &String| !name.is_empty() && figure.name.starts_with(name.as_str());
    if let Some(name) = names.iter().find(|name| !figures::TABLE.iter().any(|figure| begins(figure, name))) {
        let known = figures::TABLE.iter().map(|figure| figure.name).collect::<Vec<_>>().join(", ");
        return Err(InputError::Unknown { kind: "figure", name: name.clone(), known });
    }
    Ok(figures::TABLE
        .iter()
        .copied()
        .filter(|figure| names.is_empty() || names.iter().any(|name| begins(figure, name)))
        .collect())
}

fn is_stock(name: &str) -> bool {
    stock::find(name).is_some()
}

/// A relative path that would be read as something else.
fn needs_dot(path: &str) -> bool {
    path.starts_with('-') || is_stock(path)
}

#[derive(Debug, Parser)]
#[command(
    name = "obscura",
    version,
    about = "A laboratory for the stencil buffer: shadow volumes, exactly right, on any glTF",
    long_about = "A laboratory for the stencil buffer: shadow volumes, exactly right, on any glTF.\n\n\
        Without a command it opens the window. `obscura list` names what there is.",
    args_conflicts_with_subcommands = true
)]
struct Cli {
    #[command(subcommand)]
    command: Option<Subcommands>,
    #[command(flatten)]
    window: WindowArguments,
}

#[derive(Debug, Subcommand)]
enum Subcommands {
    /// Draws one picture into a PNG file
    Render(Box<RenderArguments>),
    /// Holds what the techniques draw against exact rays, pixel by pixel
    ///
    /// Draws `--show shadow` of each light (or of light K) by each technique, and asks rays in double
    /// precision what each pixel must be. Where rays through the pixel disagree it is an edge; all others
    /// are decided. Ends with exit code 1 if a technique that claims to be exact has one wrong decided
    /// pixel; techniques known to fail only have theirs counted.
    Verify(Box<verify::VerifyArguments>),
    /// Measures how long frames take, and what their shadow volumes cost
    ///
    /// The lights go round in small circles, so that nothing can be kept from one frame to the next. Each frame is planned,
    /// drawn and waited for; some are drawn before any is measured. Printed are medians, with the 10th and the
    /// 90th percentile. `--technique` takes several, separated by commas, or `all`.
    ///
    /// With `--sweep` one thing is doubled again and again, and what that does to a frame is written into a table
    /// (CSV) and a plot (PNG): how many casters, triangles or lights a generated scene has, how often mirrors of a
    /// scene are followed (barbershop), or how many pixels it is drawn in (cubes).
    Bench(Box<bench::BenchArguments>),
    /// Draws shapes into the stencil, one after another, every state free to choose
    ///
    /// The stencil that comes of it is shown as colours and, with --numbers, as numbers. --calls prints what
    /// sets the same states in wgpu, Vulkan, Direct3D 12 or OpenGL.
    Playground(playground::PlaygroundArguments),
    /// Names the stock scenes, the techniques and what can be shown
    List {
        /// Prints JSON
        #[arg(long)]
        json: bool,
    },
    /// Prints what was imported, and how each mesh's shadow volume will be built
    Info {
        /// A stock scene's name, or a .gltf or .glb file (`./name` where a file has a stock name)
        #[arg(value_name = "SCENE")]
        scene: OsString,
        /// Prints JSON
        #[arg(long)]
        json: bool,
        /// Adds a floor beneath a file's scene
        #[arg(long)]
        floor: bool,
    },
    /// Draws the papers' figures into a folder, and a page that shows them all
    ///
    /// Without names all of them; a paper's letter (k, m, l, b, c), or the beginning of a name such as k19, stands for every
    /// figure that begins with it.
    Figures {
        /// Such as k03a; all of them where none is named
        #[arg(value_name = "NAME")]
        names: Vec<String>,
        /// The folder; made where it is missing
        #[arg(long, value_name = "DIR")]
        out: PathBuf,
        /// Pixels [default: 1280x720]
        #[arg(long, value_name = "WxH", allow_hyphen_values = true, value_parser = size)]
        size: Option<[u32; 2]>,
    },
    /// Draws each stock scene by each technique, and everything that can be shown, into a folder
    Tour {
        /// The folder; made where it is missing
        #[arg(long, value_name = "DIR", default_value = "out")]
        out: PathBuf,
    },
}

#[derive(Debug, Clone, PartialEq, Args)]
struct WindowArguments {
    /// A stock scene's name, or a .gltf or .glb file (`./name` where a file has a stock name)
    #[arg(value_name = "SCENE")]
    scene: Option<OsString>,
    #[command(flatten)]
    picture: picture::PictureArguments,
    /// Whether frames wait for the screen
    #[arg(long, value_enum, value_name = "on|off", hide_possible_values = true)]
    vsync: Option<Switch>,
    /// Closes the window after this many frames
    #[arg(long, value_name = "N")]
    frames: Option<u64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Switch {
    On,
    Off,
}

#[derive(Debug, Args)]
struct RenderArguments {
    /// A stock scene's name, or a .gltf or .glb file (`./name` where a file has a stock name); may be left
    /// out with --failure, which brings its own
    #[arg(value_name = "SCENE", required_unless_present = "failure")]
    scene: Option<OsString>,
    /// The PNG file to write
    #[arg(long, value_name = "FILE.png")]
    out: PathBuf,
    #[command(flatten)]
    picture: picture::PictureArguments,
    /// Prints what was drawn, and how long it took, as JSON
    #[arg(long)]
    json: bool,
}

fn names<const N: usize>(all: [&str; N]) -> String {
    all.join(", ")
}

fn by_name<T: Copy, const N: usize>(
    kind: &'static str,
    name: &str,
    all: [T; N],
    name_of: fn(T) -> &'static str,
) -> Result<T, InputError> {
    all.into_iter().find(|&one| name_of(one) == name).ok_or_else(|| InputError::Unknown {
        kind,
        name: name.into(),
        known: names(all.map(name_of)),
    })
}

/// A whole number. One too large for any scene stays too large: it is out of range, not unreadable.
fn index(text: &str) -> Result<usize, String> {
    if text.is_empty() || !text.bytes().all(|byte| byte.is_ascii_digit()) {
        return Err("expected a whole number from 0".into());
    }
    Ok(text.parse().unwrap_or(usize::MAX))
}

fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| index(text).map(|side| u32::try_from(side).unwrap_or(u32::MAX));
    text.split_once(['x', 'X'])
        .and_then(|(width, height)| Some([side(width).ok()?, side(height).ok()?]))
        .ok_or_else(|| format!("expected WIDTHxHEIGHT, each side 1 to {MAX_SIZE}, such as 1280x720"))
}

fn point(text: &str) -> Result<DVec3, String> {
    let [x, y, z] = numbers(text, ',').ok_or("expected three numbers, such as 1.5,2,-3")?;
    Ok(DVec3::new(x, y, z))
}

/// Exactly `N` numbers, separated.
fn numbers<T: FromStr, const N: usize>(text: &str, separator: char) -> Option<[T; N]> {
    let all = text.split(separator).map(|number| number.trim().parse().ok()).collect::<Option<Vec<T>>>()?;
    all.try_into().ok()
}

fn animation(text: &str) -> Result<AnimationChoice, String> {
    match text {
        "all" => Ok(AnimationChoice::All),
        "still" => Ok(AnimationChoice::Still),
        _ => index(text).map(AnimationChoice::One).map_err(|_| "expected all, still, or an animation's index from 0".into()),
    }
}

#[cfg(test)]
mod tests;
