//! The options that put two solids together, to [`Csg`] and back.

use clap::Args;

use super::command_line::Line;
use super::input::InputError;
use super::{by_name, index, names};
use crate::scene::{Scene, Unfit};
use crate::settings::{Csg, Operation};

/// What both the window and `render` understand of it.
#[derive(Debug, Clone, PartialEq, Args)]
pub(super) struct CsgArguments {
    #[arg(long, value_name = "OPERATION", help = format!("Puts two solids together: {} [default: the scene's]", names(Operation::ALL.map(Operation::name))))]
    csg: Option<String>,
    /// The node that shows A: a closed mesh [default: the scene's]
    #[arg(long, value_name = "NODE", allow_hyphen_values = true, value_parser = index)]
    csg_a: Option<usize>,
    /// The node that shows B: a closed mesh [default: the scene's]
    #[arg(long, value_name = "NODE", allow_hyphen_values = true, value_parser = index)]
    csg_b: Option<usize>,
}

impl CsgArguments {
    /// Changes `csg` as the arguments say.
    pub fn apply(&self, csg: &mut Csg) -> Result<(), InputError> {
        if let Some(name) = &self.csg {
            csg.operation = Some(by_name("operation", name, Operation::ALL, Operation::name)?);
        }
        csg.a = self.csg_a.or(csg.a);
        csg.b = self.csg_b.or(csg.b);
        Ok(())
    }
}

/// The options that give `csg` again.
pub(super) fn write(csg: &Csg, line: &mut Line) {
    let Csg { operation, a, b } = csg;
    if let Some(operation) = operation {
        line.option("--csg", operation.name());
    }
    for (option, node) in [("--csg-a", a), ("--csg-b", b)] {
        if let Some(node) = node {
            line.option(option, &node.to_string());
        }
    }
}

/// Says whether the nodes that `csg` speaks of can be put together.
pub(super) fn check_against(csg: &Csg, scene: &Scene) -> Result<(), InputError> {
    let Some(operands) = scene.operands_in_force(csg) else {
        let lacks = csg.operation.is_some_and(|operation| operation != Operation::Off);
        return if lacks { Err(InputError::NoOperands) } else { Ok(()) };
    };
    for (letter, node) in [('A', operands.a), ('B', operands.b)] {
        let unfit = |why: Unfit| InputError::Operand { letter, node, why: why.to_string() };
        scene.can_be_operand(node).map_err(unfit)?;
    }
    if operands.a == operands.b {
        return Err(InputError::Operand { letter: 'B', node: operands.b, why: Unfit::Twice.to_string() });
    }
    Ok(())
}
