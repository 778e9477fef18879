//! `obscura playground`, and the options that say what `--show playground` draws.

use std::path::{Path, PathBuf};

use clap::Args;

use super::command_line::Line;
use super::input::InputError;
use super::{by_name, names, scene_choice, size};
use crate::settings::boards::{self, PRESETS};
use crate::settings::{Api, Board, LONGEST_NAME, MOST_SHAPES, Playground, Settings, Show};

/// Bytes of a board's file.
const LARGEST: u64 = 1 << 20;

/// What both the window and `render` understand of it.
#[derive(Debug, Clone, PartialEq, Args)]
pub(super) struct BoardArguments {
    #[arg(long, value_name = "BOARD", help = format!("What `--show playground` draws: a JSON file, JSON itself, or one of {}", preset_names()))]
    board: Option<String>,
    /// Writes the stencil's values over `--show playground`, in a grid
    #[arg(long)]
    numbers: bool,
}

impl BoardArguments {
    /// Changes `playground` as the arguments say.
    pub fn apply(&self, playground: &mut Playground) -> Result<(), InputError> {
        if let Some(word) = &self.board {
            playground.board = read(word)?;
        }
        playground.numbers |= self.numbers;
        Ok(())
    }
}

/// Of `obscura playground`.
#[derive(Debug, Args)]
pub(super) struct PlaygroundArguments {
    #[arg(value_name = "BOARD", help = format!("A JSON file, JSON itself, or one of {} [default: {}]", preset_names(), PRESETS[0].name))]
    board: Option<String>,
    /// The PNG file to write
    #[arg(long, value_name = "FILE.png", required_unless_present = "calls")]
    out: Option<PathBuf>,
    /// Writes the stencil's values over the picture, in a grid
    #[arg(long)]
    numbers: bool,
    #[arg(long, value_name = "API", help = format!("Prints the calls that set each shape's state: {}", names(Api::ALL.map(Api::name))))]
    calls: Option<String>,
    /// Pixels [default: 1280x720]
    #[arg(long, value_name = "WxH", allow_hyphen_values = true, value_parser = size)]
    size: Option<[u32; 2]>,
    /// The graphics adapter: part of its name
    #[arg(long, value_name = "SUBSTRING", allow_hyphen_values = true)]
    adapter: Option<String>,
}

impl PlaygroundArguments {
    /// What is drawn, where to, and whose calls are printed.
    pub fn request(self) -> Result<super::Command, InputError> {
        let calls = self.calls.map(|name| by_name("interface", &name, Api::ALL, Api::name)).transpose()?;
        let board = self.board.map_or_else(|| Ok(Board::default()), |word| read(&word))?;
        // A picture has a scene, though nothing of it is seen: a small one.
        let scene = scene_choice("cubes".as_ref())?;
        let mut settings = Settings { scene, show: Show::Playground, adapter: self.adapter, ..Settings::default() };
        settings.playground = Playground { board, numbers: self.numbers };
        settings.size = self.size.unwrap_or(settings.size);
        super::check(&settings)?;
        Ok(super::Command::Playground { settings, out: self.out, calls })
    }
}

fn preset_names() -> String {
    PRESETS.iter().map(|preset| preset.name).collect::<Vec<_>>().join(", ")
}

/// A board by its name, as JSON, or from a file.
fn read(word: &str) -> Result<Board, InputError> {
    if let Some(preset) = boards::find(word) {
        return Ok((preset.build)());
    }
    let inline = word.trim_start().starts_with('{');
    let name = if inline { "given".to_owned() } else { word.to_owned() };
    let fault = |why: String| InputError::Board { name: name.clone(), why };
    let text = if inline {
        word.to_owned()
    } else {
        let data =
            Path::new(word).metadata().map_err(|error| fault(format!("{error}; boards with a name are: {}", preset_names())))?;
        if !data.is_file() || data.len() > LARGEST {
            return Err(fault("it is no file of JSON".into()));
        }
        std::fs::read_to_string(word).map_err(|error| fault(error.to_string()))?
    };
    let board = serde_json::from_str(&text).map_err(|error| fault(error.to_string()))?;
    match flaw(&board) {
        Some(why) => Err(fault(why)),
        None => Ok(board),
    }
}

/// The options that give `playground` again.
pub(super) fn write(playground: &Playground, line: &mut Line) {
    let Playground { board, numbers } = playground;
    if *board != Board::default() {
        match boards::name_of(board) {
            Some(name) => line.option("--board", name),
            None => line.option("--board", &serde_json::to_string(board).unwrap_or_default()),
        }
    }
    if *numbers {
        line.word("--numbers");
    }
}

/// Says whether a board can be drawn.
pub(super) fn check(board: &Board) -> Result<(), InputError> {
    flaw(board).map_or(Ok(()), |why| Err(InputError::Board { name: "of the settings".into(), why }))
}

/// Why a board cannot be drawn.
fn flaw(board: &Board) -> Option<String> {
    if board.shapes.len() > MOST_SHAPES {
        return Some(format!("{} shapes are too many: {MOST_SHAPES} at most", board.shapes.len()));
    }
    if !(0.0..=1.0).contains(&board.clear_depth) {
        return Some(format!("depth is cleared to 0 to 1, not to {}", board.clear_depth));
    }
    for (number, shape) in (1..).zip(&board.shapes) {
        let wrong = [
            (!(0.0..=1.0).contains(&shape.depth), "its depth must be 0 to 1"),
            (shape.at.iter().any(|at| !(-4.0..=5.0).contains(at)), "its place must be shares of the picture, -4 to 5"),
            (
                shape.size.iter().any(|side| !(0.0..=8.0).contains(side)),
                "its size must be shares of the picture's height, 0 to 8",
            ),
            (!(-3600.0..=3600.0).contains(&shape.turn), "it must be turned by -3600 to 3600 degrees"),
            (shape.name.chars().count() > LONGEST_NAME, "its name has too many letters"),
        ];
        if let Some((_, words)) = wrong.into_iter().find(|(wrong, _)| *wrong) {
            return Some(format!("shape {number}: {words}"));
        }
    }
    None
}
