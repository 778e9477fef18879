//! Every key and mouse gesture, in one table: the handler, the help overlay and the README read it.

use egui::{Event, InputState, Key, Modifiers};

use crate::settings::Technique;

/// What a key asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Command {
    /// Counts shadows so.
    Technique(Technique),
    /// The next technique in the table.
    NextTechnique,
    /// The next thing to show.
    NextShow,
    /// The next light for stencil, shadow and volumes.
    NextLight,
    /// The next of the stock scenes.
    NextScene,
    /// The next of the scene's cameras.
    NextCamera,
    /// The scene's first camera.
    ResetCamera,
    /// Orbit or fly.
    ToggleMode,
    /// Time goes or stands.
    TogglePlay,
    /// Time stands, this many steps further on.
    Step(i32),
    /// Time goes this many times twice as fast.
    Faster(i32),
    /// 1 or 4 samples a pixel.
    ToggleSamples,
    /// Clicks on the picture make mirrors, or do not any more.
    MakeMirrors,
    /// Clicks on the picture mark receivers of planar shadows, or do not any more.
    MarkReceivers,
    /// Light icons over the picture.
    ToggleIcons,
    /// The side panel.
    TogglePanel,
    /// The help overlay.
    ToggleHelp,
    /// Leaves what is open on top.
    Close,
    /// Saves the picture.
    Screenshot,
    /// Copies the command that draws the picture.
    CopyCommand,
    /// Goes to the field where a path is typed.
    OpenPath,
    /// Reads the scene's file again.
    Reload,
    /// Throws the graphics device away.
    LoseDevice,
    /// The whole screen, or a window.
    ToggleFullscreen,
    /// Ends the program.
    Quit,
}

/// A group of the table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// What is drawn.
    Picture,
    /// Where from.
    Camera,
    /// When.
    Time,
    /// Everything else.
    Window,
}

impl Group {
    /// All, in the order people see them.
    pub const ALL: [Self; 4] = [Self::Picture, Self::Camera, Self::Time, Self::Window];

    /// Its heading.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Picture => "Picture",
            Self::Camera => "Camera and lights",
            Self::Time => "Time",
            Self::Window => "Window",
        }
    }
}

/// A key with its modifiers, and what it asks for.
#[derive(Debug, Clone, Copy)]
pub struct Binding {
    /// The key.
    pub key: Key,
    /// Ctrl (Cmd on a Mac) and Shift have to match, others do not matter.
    pub modifiers: Modifiers,
    /// What it asks for.
    pub command: Command,
}

/// One row of the help overlay.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    /// Where it stands.
    pub group: Group,
    /// The keys as people read them.
    pub keys: &'static str,
    /// What they do.
    pub about: &'static str,
    /// Single presses. Empty for gestures and for keys that are held.
    pub bindings: &'static [Binding],
}

const fn press(key: Key, command: Command) -> Binding {
    Binding { key, modifiers: Modifiers::NONE, command }
}

const fn ctrl(key: Key, command: Command) -> Binding {
    Binding { key, modifiers: Modifiers::COMMAND, command }
}

const fn row(group: Group, keys: &'static str, about: &'static str, bindings: &'static [Binding]) -> Row {
    Row { group, keys, about, bindings }
}

/// Every key and gesture.
pub static TABLE: &[Row] = &[
    row(
        Group::Picture,
        "1 2 3 4",
        "no shadows, z-pass, z-fail, exact z-pass",
        &[
            press(Key::Num1, Command::Technique(Technique::None)),
            press(Key::Num2, Command::Technique(Technique::ZPass)),
            press(Key::Num3, Command::Technique(Technique::ZFail)),
            press(Key::Num4, Command::Technique(Technique::ExactZPass)),
        ],
    ),
    row(Group::Picture, "T", "next technique", &[press(Key::T, Command::NextTechnique)]),
    row(
        Group::Picture,
        "V",
        "next view: final, stencil, shadow, overflow, volumes, cases, bounds, wireframe, views, surfaces, birdseye, complexity, rays, playground",
        &[press(Key::V, Command::NextShow)],
    ),
    row(Group::Picture, "L", "next light for stencil, shadow and volumes", &[press(Key::L, Command::NextLight)]),
    row(Group::Picture, "N", "next stock scene", &[press(Key::N, Command::NextScene)]),
    row(Group::Picture, "M", "1 or 4 samples a pixel", &[press(Key::M, Command::ToggleSamples)]),
    row(
        Group::Picture,
        "X",
        "clicks make mirrors: a flat surface becomes one, a mirror none; again to end",
        &[press(Key::X, Command::MakeMirrors)],
    ),
    row(
        Group::Picture,
        "Z",
        "clicks mark receivers of planar shadows: a flat surface becomes one, a receiver none; again to end",
        &[press(Key::Z, Command::MarkReceivers)],
    ),
    row(Group::Camera, "drag", "turn about the target (orbit), or look around (fly)", &[]),
    row(Group::Camera, "right drag", "move sideways with the target", &[]),
    row(Group::Camera, "wheel", "nearer, farther (orbit); flying speed (fly)", &[]),
    row(Group::Camera, "W A S D, Q E", "fly; down and up; with Shift four times as fast", &[]),
    row(Group::Camera, "O", "orbit or fly", &[press(Key::O, Command::ToggleMode)]),
    row(Group::Camera, "C", "next camera of the scene", &[press(Key::C, Command::NextCamera)]),
    row(Group::Camera, "R", "back to the scene's first camera", &[press(Key::R, Command::ResetCamera)]),
    row(Group::Camera, "drag a light", "move it in the plane facing the camera; with Shift along one axis", &[]),
    row(Group::Camera, "G", "show or hide the lights' icons", &[press(Key::G, Command::ToggleIcons)]),
    row(Group::Time, "Space", "play or pause", &[press(Key::Space, Command::TogglePlay)]),
    row(
        Group::Time,
        ". ,",
        "one step on, one step back",
        &[press(Key::Period, Command::Step(1)), press(Key::Comma, Command::Step(-1))],
    ),
    row(
        Group::Time,
        "] [",
        "twice as fast, half as fast",
        &[press(Key::CloseBracket, Command::Faster(1)), press(Key::OpenBracket, Command::Faster(-1))],
    ),
    row(Group::Window, "F1 H", "this help", &[press(Key::F1, Command::ToggleHelp), press(Key::H, Command::ToggleHelp)]),
    row(Group::Window, "F2", "show or hide the panel", &[press(Key::F2, Command::TogglePanel)]),
    row(Group::Window, "F5", "read the scene again", &[press(Key::F5, Command::Reload)]),
    row(Group::Window, "F9", "lose the graphics device, to see everything rebuilt", &[press(Key::F9, Command::LoseDevice)]),
    row(Group::Window, "F11", "full screen", &[press(Key::F11, Command::ToggleFullscreen)]),
    row(
        Group::Window,
        "F12 P",
        "save the picture; its metadata holds the command that draws it again",
        &[press(Key::F12, Command::Screenshot), press(Key::P, Command::Screenshot)],
    ),
    row(Group::Window, "Ctrl+C", "copy the command that draws this picture", &[ctrl(Key::C, Command::CopyCommand)]),
    row(Group::Window, "Ctrl+O", "type or paste the path of a file to open", &[ctrl(Key::O, Command::OpenPath)]),
    row(
        Group::Window,
        "Esc",
        "close the help, leave a field, make no more mirrors or receivers",
        &[press(Key::Escape, Command::Close)],
    ),
    row(Group::Window, "Ctrl+Q", "quit", &[ctrl(Key::Q, Command::Quit)]),
];

/// What the keys pressed since the last frame ask for. A key that is held does not repeat,
/// except to step through time.
#[must_use]
pub fn pressed(input: &InputState) -> Vec<Command> {
    input.events.iter().filter_map(command_of).collect()
}

/// The name of the key that asks for `command`, where one does.
#[must_use]
pub fn key_of(command: Command) -> Option<&'static str> {
    TABLE.iter().flat_map(|row| row.bindings).find(|binding| binding.command == command).map(|binding| binding.key.name())
}

fn command_of(event: &Event) -> Option<Command> {
    let (key, repeat, modifiers) = match event {
        Event::Key { key, pressed: true, repeat, modifiers, .. } => (*key, *repeat, *modifiers),
        // The window system turns Ctrl+C into this.
        Event::Copy => (Key::C, false, Modifiers::COMMAND),
        _ => return None,
    };
    if modifiers.alt {
        return None;
    }
    let bindings = TABLE.iter().flat_map(|row| row.bindings);
    let binding = bindings.into_iter().find(|binding| binding.key == key && binding.modifiers.command == modifiers.command)?;
    (!repeat || matches!(binding.command, Command::Step(_))).then_some(binding.command)
}

/// The keys that fly while they are held: right, up and forward, -1 to 1 each.
#[must_use]
pub fn flight(input: &InputState) -> [f64; 3] {
    if input.modifiers.command || input.modifiers.alt {
        return [0.0; 3];
    }
    let axis = |plus: Key, minus: Key| f64::from(i8::from(input.key_down(plus)) - i8::from(input.key_down(minus)));
    [axis(Key::D, Key::A), axis(Key::E, Key::Q), axis(Key::W, Key::S)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_asks_for_two_things() {
        let mut seen = Vec::new();
        for binding in TABLE.iter().flat_map(|row| row.bindings) {
            let chord = (binding.key, binding.modifiers.command);
            assert!(!seen.contains(&chord), "{chord:?} is bound twice");
            seen.push(chord);
        }
        for key in [Key::W, Key::A, Key::S, Key::D, Key::Q, Key::E] {
            assert!(!seen.contains(&(key, false)), "{key:?} flies");
        }
    }

    #[test]
    fn the_first_techniques_have_their_keys() {
        for technique in [Technique::None, Technique::ZPass, Technique::ZFail, Technique::ExactZPass] {
            assert!(TABLE.iter().flat_map(|row| row.bindings).any(|binding| binding.command == Command::Technique(technique)));
        }
    }

    #[test]
    fn modifiers_tell_keys_apart() {
        let event = |key, modifiers, repeat| Event::Key { key, physical_key: None, pressed: true, repeat, modifiers };
        assert_eq!(command_of(&event(Key::C, Modifiers::NONE, false)), Some(Command::NextCamera));
        assert_eq!(command_of(&event(Key::C, Modifiers::COMMAND, false)), Some(Command::CopyCommand));
        assert_eq!(command_of(&Event::Copy), Some(Command::CopyCommand));
        assert_eq!(command_of(&event(Key::C, Modifiers::ALT, false)), None);
        assert_eq!(command_of(&event(Key::T, Modifiers::NONE, true)), None, "held keys do not repeat");
        assert_eq!(command_of(&event(Key::Period, Modifiers::NONE, true)), Some(Command::Step(1)), "but steps do");
    }
}
