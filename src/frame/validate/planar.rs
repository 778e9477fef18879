//! What holds for receivers of planar shadows: whose value is asked for, by whose shadows, and in which order.

use super::Progress;
use crate::frame::plan::FramePlan;
use crate::frame::state::{Compare, Depth, DepthBias};
use crate::frame::stencil::{StencilOp, StencilState};
use crate::frame::step::{Draw, DrawSet, Program, Surface};

/// A receiver whose visible pixels are tagged, with what shares its plane.
#[derive(Debug, Clone)]
pub(super) struct Tagged {
    surfaces: Vec<Surface>,
    /// What pixels hold that are not in shadow.
    now: u8,
    /// What shadows have made of others, and of which light.
    shadowed: Option<(u8, Option<usize>)>,
    /// How its surfaces are being drawn, and which were.
    drawn: Option<(Drawn, Vec<Surface>)>,
}

/// What the surfaces of one value have in common where one thing is done to all of them.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Drawn {
    program: Program,
    light: Option<usize>,
    stencil: StencilState,
    reference: u8,
}

/// A draw that asks for receivers' bits, or changes them.
pub(super) fn check(plan: &FramePlan, draw: &Draw, state: &mut Progress) -> Result<(), &'static str> {
    let (budget, stencil) = (plan.budget, draw.state.stencil);
    if stencil == StencilState::forget_receivers(budget) {
        if draw.set != DrawSet::FullScreen || draw.program != Program::StencilOnly || draw.stencil_reference != 0 {
            return Err("receivers are forgotten everywhere at once");
        }
        state.receivers.clear();
        return Ok(());
    }
    match &draw.set {
        DrawSet::Surfaces(surfaces) => {
            let [surface] = surfaces[..] else { return Err("receivers are drawn one by one") };
            if draw.state.depth.with_bias(DepthBias::NONE) != Depth::SAME_SURFACE {
                return Err("a receiver is drawn where it is seen: at its own depth");
            }
            check_receiver(plan, draw, surface, state)
        }
        DrawSet::Volumes(parts) => {
            let value = draw.stencil_reference & budget.receiver_mask;
            let Some(tagged) = state.receivers.get_mut(&value) else {
                return Err("shadows fall on a receiver that is not tagged");
            };
            if draw.state.depth.compare != Compare::Always || draw.state.depth.write {
                return Err("depth has no say in where a planar shadow falls: the tag has");
            }
            for part in parts {
                let volume = plan.volumes.get(part.volume).ok_or("it draws a volume that is not planned")?;
                if volume.projection.is_none_or(|projection| !tagged.surfaces.contains(&projection.receiver)) {
                    return Err("a shadow falls on another receiver than it was thrown onto");
                }
                if Some(volume.light) != draw.light {
                    return Err("it throws another light's shadow");
                }
            }
            if stencil == StencilState::shadow_receiver(budget) && budget.verdict_mask != 0 {
                if state.counted.is_some_and(|light| Some(light) != draw.light) {
                    return Err("it adds shadows to another light's count");
                }
                state.counted = draw.light;
                return Ok(());
            }
            let after = moved(plan, draw).ok_or("a shadow marks each of a receiver's pixels once, or puts it in shadow")?;
            if draw.stencil_reference != tagged.now {
                return Err("a shadow falls on pixels that are in one already");
            }
            tagged.shadowed = Some((after, draw.light));
            tagged.drawn = None;
            Ok(())
        }
        _ => Err("only receivers and shadows have to do with receivers' bits"),
    }
}

fn check_receiver(plan: &FramePlan, draw: &Draw, surface: Surface, state: &mut Progress) -> Result<(), &'static str> {
    let (budget, stencil) = (plan.budget, draw.state.stencil);
    let tag = stencil.write_mask;
    if tag & budget.receiver_mask == tag && tag != 0 && stencil == StencilState::tag_receiver(budget, tag) {
        if draw.stencil_reference != 0 || draw.state.color.is_some() {
            return Err("a receiver is tagged where none is yet, and nothing else is done");
        }
        let Some(tagged) = state.receivers.get(&tag) else {
            state.receivers.insert(tag, Tagged { surfaces: vec![surface], now: tag, shadowed: None, drawn: None });
            return Ok(());
        };
        let apart = |other: &Surface| *other == surface || !state.shares_ground(*other, surface);
        if tagged.now != tag || tagged.shadowed.is_some() || tagged.surfaces.iter().any(apart) {
            return Err("two receivers have one value");
        }
        state.receivers.entry(tag).and_modify(|tagged| tagged.surfaces.push(surface));
        return Ok(());
    }
    let value = draw.stencil_reference & budget.receiver_mask;
    let Some(tagged) = state.receivers.get_mut(&value).filter(|tagged| tagged.surfaces.contains(&surface)) else {
        return Err("it asks for another receiver's value");
    };
    let reference = draw.stencil_reference;
    let drawn = Drawn { program: draw.program, light: draw.light, stencil, reference };
    match &mut tagged.drawn {
        // The same is done to another part of it.
        Some((before, surfaces)) if *before == drawn && !surfaces.contains(&surface) => {
            surfaces.push(surface);
            return Ok(());
        }
        other => *other = Some((drawn, vec![surface])),
    }
    let in_shadow = tagged.shadowed.is_some_and(|(value, _)| value == reference);
    match (draw.program, moved(plan, draw)) {
        // Light, and the lit pixels go where the shadowed ones are.
        (Program::Lit, Some(after)) if reference == tagged.now => {
            if tagged.shadowed.take().is_some_and(|shadowed| shadowed != (after, draw.light)) {
                return Err("it adds a light by another light's shadow");
            }
            tagged.now = after;
            Ok(())
        }
        (Program::Verdict, None) if reference == tagged.now && !stencil.writes() => Ok(()),
        // Drawn anew: from there on only those pixels matter, or all are as before.
        (Program::Ambient | Program::AmbientMasked, after) if in_shadow && (after.is_some() || !stencil.writes()) => {
            tagged.now = after.unwrap_or(reference);
            tagged.shadowed = None;
            Ok(())
        }
        _ => Err("a receiver is lit where it is not in shadow, or drawn anew where it is"),
    }
}

/// What pixels hold after a draw that moves those on which hold its reference.
fn moved(plan: &FramePlan, draw: &Draw) -> Option<u8> {
    let reference = draw.stencil_reference;
    let steps = [
        (StencilOp::IncrementWrap, reference.wrapping_add(1)),
        (StencilOp::DecrementWrap, reference.wrapping_sub(1)),
        (StencilOp::Zero, 0),
    ];
    let found = steps.into_iter().find(|(step, _)| draw.state.stencil == StencilState::move_on(plan.budget, *step))?;
    let stays = found.0 == StencilOp::Zero || (found.1 ^ reference) & plan.budget.receiver_mask == 0;
    stays.then_some(found.1)
}
