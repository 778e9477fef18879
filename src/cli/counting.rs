//! The options that say what shadows are counted in, to [`Counting`] and back.

use clap::Args;

use super::command_line::Line;
use super::input::InputError;
use super::{by_name, names};
use crate::settings::{Counting, MAX_COUNT_BITS, Overflow};

/// What both the window and `render` understand of it.
#[derive(Debug, Clone, PartialEq, Args)]
pub(super) struct CountingArguments {
    /// Bits of the stencil that shadows are counted in, 1 to 8 [default: 8]
    #[arg(long, value_name = "N")]
    count_bits: Option<u32>,
    #[arg(long, value_name = "O", help = format!("Where more volumes overlap than the bits can count: {}", names(Overflow::ALL.map(Overflow::name))))]
    overflow: Option<String>,
}

impl CountingArguments {
    /// Changes `counting` as the arguments say.
    pub fn apply(&self, counting: &mut Counting) -> Result<(), InputError> {
        counting.bits = self.count_bits.unwrap_or(counting.bits);
        if let Some(name) = &self.overflow {
            counting.overflow = by_name("overflow", name, Overflow::ALL, Overflow::name)?;
        }
        Ok(())
    }
}

/// The options that give `counting` again.
pub(super) fn write(counting: &Counting, line: &mut Line) {
    let default = Counting::default();
    if counting.bits != default.bits {
        line.option("--count-bits", &counting.bits.to_string());
    }
    if counting.overflow != default.overflow {
        line.option("--overflow", counting.overflow.name());
    }
}

/// Says whether the stencil has these bits.
pub(super) fn check(counting: &Counting) -> Result<(), InputError> {
    let (value, most) = (counting.bits, MAX_COUNT_BITS);
    if (1..=most).contains(&value) {
        Ok(())
    } else {
        Err(InputError::Range { what: "the bits of the count", value, least: 1, most })
    }
}
