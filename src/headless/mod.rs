//! Everything without a window: pictures, lists and reports.

mod save;

pub use save::{COMMAND_KEY, SaveError, check_target, read_command, save_png};
