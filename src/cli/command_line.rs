//! Settings to the command line that draws them again.

use std::borrow::Cow;

use super::{
    complexity as complexity_options, counting as counting_options, csg as csg_options, culling as culling_options,
    decals as decal_options, diagram as diagram_options, dissolve as dissolve_options, halo as halo_options, light_edit,
    lighting as lighting_options, mirrors as mirror_options, needs_dot, planar as planar_options,
    playground as playground_options, silhouettes as silhouette_options,
};
use crate::scene::AnimationChoice;
use crate::settings::{CameraChoice, SceneChoice, Settings};

/// The file that [`render_command`] writes to: whoever runs it will want a name of their own.
const OUT: &str = "obscura.png";

/// The `obscura render ...` line that draws `settings` again, quoted for a POSIX shell. What
/// stands at its default is left out; numbers keep every bit, so the same picture comes back.
///
/// Paths that are not UTF-8 cannot be written in a line of text and come out approximately.
#[must_use]
pub fn render_command(settings: &Settings) -> String {
    let mut line = Line::default();
    line.word("obscura");
    line.word("render");
    line.scene(&settings.scene);
    line.option("--out", OUT);
    picture_options(settings, &mut line);
    line.finish()
}

/// The options that give `settings` again, but for the scene.
pub(super) fn picture_options(settings: &Settings, line: &mut Line) {
    let Settings {
        scene: _,
        floor,
        technique,
        show,
        failure,
        light,
        size,
        samples,
        camera,
        fov,
        far,
        time,
        animation,
        smooth_terminator,
        exposure,
        lights,
        lighting,
        counting,
        culling,
        silhouettes,
        complexity,
        diagram,
        adapter,
        shaders,
        mirrors,
        playground,
        decals,
        dissolve,
        halos,
        csg,
        planar,
    } = settings;
    let default = Settings::default();
    if *technique != default.technique {
        line.option("--technique", technique.name());
    }
    if *show != default.show {
        line.option("--show", show.name());
    }
    if let Some(failure) = failure {
        line.option("--failure", failure.name());
    }
    if *light != default.light {
        line.option("--light", &light.to_string());
    }
    if *size != default.size {
        line.option("--size", &format!("{}x{}", size[0], size[1]));
    }
    if *samples != default.samples {
        line.option("--samples", &samples.to_string());
    }
    match camera {
        CameraChoice::First => {}
        CameraChoice::Named(name) => line.option("--camera", name),
        CameraChoice::Free { eye, target } => {
            line.option("--eye", &format!("{},{},{}", eye.x, eye.y, eye.z));
            line.option("--target", &format!("{},{},{}", target.x, target.y, target.z));
        }
    }
    if let Some(degrees) = fov {
        line.option("--fov", &degrees.to_string());
    }
    if let Some(metres) = far {
        line.option("--far", &metres.to_string());
    }
    if *time != default.time {
        line.option("--time", &time.to_string());
    }
    match animation {
        None => {}
        Some(AnimationChoice::All) => line.option("--animation", "all"),
        Some(AnimationChoice::Still) => line.option("--animation", "still"),
        Some(AnimationChoice::One(index)) => line.option("--animation", &index.to_string()),
    }
    if *floor {
        line.word("--floor");
    }
    if *exposure != default.exposure {
        line.option("--exposure", &exposure.to_string());
    }
    if !smooth_terminator {
        line.word("--no-smooth-terminator");
    }
    for (light, edit) in lights {
        line.option("--light-edit", &light_edit::format(*light, edit));
    }
    lighting_options::write(lighting, line);
    counting_options::write(counting, line);
    culling_options::write(culling, line);
    silhouette_options::write(*silhouettes, line);
    complexity_options::write(*complexity, line);
    diagram_options::write(*diagram, line);
    decal_options::write(*decals, line);
    dissolve_options::write(dissolve, line);
    playground_options::write(playground, line);
    mirror_options::write(mirrors, line);
    halo_options::write(halos, line);
    csg_options::write(csg, line);
    planar_options::write(planar, line);
    if let Some(adapter) = adapter {
        line.option("--adapter", adapter);
    }
    if let Some(folder) = shaders {
        line.option("--shaders", &folder.to_string_lossy());
    }
}

/// Words of a command line, quoted.
#[derive(Default)]
pub(super) struct Line {
    text: String,
}

impl Line {
    /// A scene's name; a file's where it would be taken for something else as `./name`.
    pub fn scene(&mut self, scene: &SceneChoice) {
        self.word(&match scene {
            SceneChoice::Stock(name) => Cow::Borrowed(name.as_str()),
            SceneChoice::File(path) => match path.to_string_lossy() {
                path if needs_dot(&path) => format!("./{path}").into(),
                path => path,
            },
        });
    }

    /// All of it.
    pub fn finish(self) -> String {
        self.text
    }

    pub fn word(&mut self, word: &str) {
        // A NUL can stand neither in a path nor in a command line.
        let word = word.replace('\0', "");
        if !self.text.is_empty() {
            self.text.push(' ');
        }
        self.text.push_str(&shlex::try_quote(&word).unwrap_or_default());
    }

    /// The value joined to the name where it would be taken for another option.
    pub fn option(&mut self, name: &str, value: &str) {
        if value.starts_with('-') {
            self.word(&format!("{name}={value}"));
        } else {
            self.word(name);
            self.word(value);
        }
    }
}
