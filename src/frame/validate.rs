//! Checks a plan without a GPU. A fault here is a bug in the director or a technique, caught where
//! it can be read instead of where it can only be seen.

mod decals;
mod deferred;
mod fragments;
mod halo;
mod mirrors;
mod planar;
mod shapes;
mod solid;

use std::collections::BTreeMap;

use serde::Serialize;
use thiserror::Error;

use super::plan::{FramePlan, Method};
use super::state::{Blend, Compare, Cull, Depth, NearPlane, State};
use super::stencil::{StencilFace, StencilOp, StencilState};
use super::step::{Action, Draw, DrawSet, Part, Program, Step, Surface, Target, VolumePart};

/// A rule that a plan may break on purpose, where it shows what comes of it: see
/// [`crate::failures`]. All others hold always.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Rule {
    /// Exact z-pass is counted under depth clamp, and nothing else is.
    ExactZPassClamps,
}

/// What is wrong with a plan, and with which step.
#[derive(Debug, Error, PartialEq, Eq)]
#[error("step {step} ({label}): {what}")]
pub struct Fault {
    /// Its number.
    pub step: usize,
    /// Its label.
    pub label: String,
    /// What is wrong.
    pub what: &'static str,
}

/// Checks that a plan can be carried out and means what it should.
///
/// # Errors
/// The first fault found.
pub fn validate(plan: &FramePlan) -> Result<(), Fault> {
    let mut state = Progress::default();
    for (number, step) in plan.steps.iter().enumerate() {
        let fault = |what| Fault { step: number, label: step.label.clone(), what };
        if step.view >= plan.views.len() {
            return Err(fault("it draws a view that is not planned"));
        }
        if step.view != state.view {
            state.turn_to(step.view);
        }
        match &step.action {
            Action::Clear(clear) => {
                if state.output_begun || state.gathered {
                    return Err(fault("it clears the scene's targets after the picture has begun"));
                }
                state.color_set |= clear.color.is_some();
                state.depth_set |= clear.depth.is_some();
                state.stencil_set |= clear.stencil.is_some();
                if clear.stencil.is_some() {
                    state.bounded = None;
                    state.owned.clear();
                    state.receivers.clear();
                    state.shone = 0;
                    state.tagged = false;
                    state.fragments = false;
                    state.counting = false;
                    state.counted = None;
                    state.field_known = true;
                }
                if clear.counts.is_some() {
                    state.counts_set = true;
                    state.wide = None;
                }
            }
            Action::Keep
                if plan.views[step.view].texture.is_none() || !state.color_set || state.gathered || state.output_begun =>
            {
                return Err(fault("it keeps what has no texture, or is not drawn"));
            }
            Action::Keep => state.kept.push(step.view),
            Action::Draw(draw) => mirrors::check(plan, step.view, draw, &mut state).map_err(fault)?,
        }
    }
    if !state.open.is_empty() {
        let label = plan.steps.last().map(|step| step.label.clone()).unwrap_or_default();
        return Err(Fault { step: plan.steps.len().saturating_sub(1), label, what: "a mirror's pixels stay tagged" });
    }
    match plan.steps.last() {
        Some(_) if state.output_begun || state.direct => Ok(()),
        // Kept for the frame after it, which makes the picture.
        Some(Step { view: 0, action: Action::Keep, .. }) if plan.then.is_some() => plan.then.as_deref().map_or(Ok(()), validate),
        last => Err(Fault {
            step: plan.steps.len().saturating_sub(1),
            label: last.map(|step| step.label.clone()).unwrap_or_default(),
            what: "the plan ends without a picture",
        }),
    }
}

#[derive(Default)]
struct Progress {
    /// Whose steps these are.
    view: usize,
    /// The views whose mirrors' pixels are tagged, each seen in the one before.
    open: Vec<usize>,
    /// Views that textures keep by now.
    kept: Vec<usize>,
    /// What the bits hold that count is this view's.
    field_known: bool,
    color_set: bool,
    depth_set: bool,
    stencil_set: bool,
    counting: bool,
    gathered: bool,
    output_begun: bool,
    /// The picture is drawn directly, under the scene's depth and stencil.
    direct: bool,
    /// Which single bits belong to which light, or to what is added without one, since the stencil was cleared.
    owned: BTreeMap<u8, Option<usize>>,
    /// Bits that surfaces were marked in when they took light.
    shone: u8,
    /// The ground of decals is marked.
    ground_marked: bool,
    /// Each ground that was, with the decals that claimed it.
    grounds: Vec<Vec<Surface>>,
    /// Shapes of the playground were drawn.
    played: bool,
    /// The stencil holds how many fragments fell on each pixel, since it was cleared.
    fragments: bool,
    /// Whose bounds are marked in the stencil, since it was cleared.
    bounded: Option<usize>,
    /// Whose volumes the stencil counts, since it was cleared.
    counted: Option<usize>,
    /// What pixels show is kept, and the bits of lights that were left.
    geometry: Option<u8>,
    /// What has a halo is tagged, since the stencil was cleared.
    tagged: bool,
    /// How far the layer in a solid's own target is.
    layer: solid::Layer,
    /// Receivers of planar shadows by their values, since the stencil was cleared.
    receivers: BTreeMap<u8, planar::Tagged>,
    counts_set: bool,
    /// Whose volumes are counted beyond the stencil, since the counts were cleared.
    wide: Option<usize>,
}

impl Progress {
    /// The steps of another view begin: it knows nothing of what the last one counted.
    fn turn_to(&mut self, view: usize) {
        *self = Self {
            view,
            counting: false,
            owned: BTreeMap::new(),
            receivers: BTreeMap::new(),
            shone: 0,
            tagged: false,
            layer: solid::Layer::None,
            bounded: None,
            counted: None,
            wide: None,
            field_known: false,
            ..std::mem::take(self)
        };
    }
}

fn check_draw(plan: &FramePlan, draw: &Draw, state: &mut Progress) -> Result<(), &'static str> {
    let [x, y, width, height] = draw.scissor;
    let inside = |start: u32, length: u32, size: u32| start.checked_add(length).is_some_and(|end| end <= size);
    if width == 0 || height == 0 || !inside(x, width, plan.size[0]) || !inside(y, height, plan.size[1]) {
        return Err("its scissor is empty or leaves the picture");
    }
    if let Some(checked) = solid::check(draw, plan.samples, state) {
        return checked;
    }
    match draw.target {
        Target::Mean | Target::Output => {
            match (draw.target, plan.gather) {
                (Target::Mean, _) if state.gathered || state.output_begun => {
                    return Err("a frame joins the mean once, before the picture");
                }
                (Target::Mean, None) => return Err("it joins a mean that the plan does not gather"),
                (Target::Mean, Some(_)) => state.gathered = true,
                (_, Some(_)) if !state.gathered => return Err("the picture has begun before the frame joined the mean"),
                _ => state.output_begun = true,
            }
            if draw.state.stencil.tests() || draw.state.stencil.writes() {
                return Err("the picture itself has no stencil");
            }
            let over_it = draw.target == Target::Output && is_overlay(&draw.set);
            if !over_it && !matches!(draw.set, DrawSet::FullScreen) {
                return Err("only full-screen steps, names and lines draw the picture");
            }
            return Ok(());
        }
        Target::Scene | Target::Direct | Target::Counts | Target::Geometry | Target::Dark | Target::Shaded if state.gathered => {
            return Err("it draws the scene after the frame joined the mean");
        }
        Target::Geometry | Target::Dark | Target::Shaded => deferred::check(plan, draw, state)?,
        Target::Direct if plan.samples != 1 => return Err("the picture has one sample a pixel"),
        Target::Direct => state.direct = true,
        Target::Scene if state.output_begun || state.direct => return Err("it draws the scene after the picture has begun"),
        Target::Counts if state.output_begun => return Err("it draws the scene after the picture has begun"),
        Target::Scene | Target::Counts | Target::Solid => {}
    }
    if !(state.color_set && state.depth_set) {
        return Err("it draws before colour and depth were cleared");
    }
    if let Some(checked) = shapes::check(plan, draw, state) {
        return checked;
    }
    let stencil = &draw.state.stencil;
    if (stencil.tests() || stencil.writes()) && !state.stencil_set {
        return Err("it tests or writes stencil bits that nobody set");
    }
    if stencil.writes() && stencil.write_mask & !plan.budget.reserved() != 0 {
        return Err("it writes stencil bits outside its budget");
    }
    let counts = stencil.read_mask & plan.budget.reserved() != 0 && stencil.tests() || stencil.writes();
    if counts && !state.field_known {
        return Err("it asks for bits, or counts in them, that another view left");
    }
    if (stencil.tests() || stencil.writes()) && draw.stencil_reference & !(stencil.read_mask | stencil.write_mask) != 0 {
        return Err("its stencil reference does not fit its masks");
    }
    if let Some(checked) = halo::check(plan, draw, state)
        .or_else(|| fragments::check(plan, draw, state))
        .or_else(|| decals::check(plan, draw, state))
    {
        return checked;
    }
    if (stencil.read_mask | stencil.write_mask) & plan.budget.receiver_mask != 0 {
        return planar::check(plan, draw, state);
    }
    if let DrawSet::Enclosure(_) = draw.set {
        return check_bounds(plan, draw, state);
    }
    if stencil.write_mask & plan.budget.beyond_mask != 0 {
        return Err("only what bounds a light marks its bounds");
    }
    if stencil.tests()
        && stencil.read_mask & plan.budget.beyond_mask != 0
        && (state.bounded.is_none() || draw.light.is_some_and(|light| state.bounded != Some(light)))
    {
        return Err("it asks for bounds that were not marked");
    }
    let others = |(bit, of): (&u8, &Option<usize>)| stencil.read_mask & bit != 0 && *of != draw.light;
    if stencil.tests() && draw.light.is_some() && state.owned.iter().any(others) {
        return Err("it asks for a bit that is another light's own");
    }
    if stencil.writes() && matches!(draw.set, DrawSet::Surfaces(_)) {
        return check_once(draw, state);
    }
    if stencil.writes() && state.shone & (stencil.write_mask | stencil.read_mask) != 0 {
        return Err("it counts in bits that surfaces which took light are marked in");
    }
    if draw.target == Target::Counts {
        return check_wide(plan, draw, state);
    }
    if draw.program == Program::VolumeNumbers {
        return Err("numbers are added up where counts are, and nowhere else");
    }
    let reads_counts =
        matches!(draw.program, Program::WideVerdict | Program::WideVerdictEach | Program::WideBit | Program::WideOverflow);
    if reads_counts && (state.wide.is_none() || state.wide != draw.light) {
        return Err("it reads counts of a light that was not counted wide");
    }
    if reads_counts && (draw.program == Program::WideVerdictEach) != (plan.samples != 1) {
        return Err("it reads counts of another number of samples");
    }
    if draw.state.depth.write && state.counting {
        return Err("it writes depth after counting began: the count would belong to another surface");
    }
    if is_overlay(&draw.set) && draw.target == Target::Scene {
        return Err("names and lines belong over the picture, not into the scene");
    }
    if let DrawSet::Volumes(parts) = &draw.set {
        if stencil.writes() {
            state.counting = true;
            if turns_own_bit(plan, stencil) {
                if *state.owned.entry(stencil.write_mask).or_insert(draw.light) != draw.light {
                    return Err("it turns over a bit that is another light's own");
                }
            } else {
                if state.counted.is_some_and(|light| Some(light) != draw.light) {
                    return Err("it counts on top of another light's count");
                }
                state.counted = draw.light;
            }
        }
        if stencil.writes() {
            check_pieces(plan, parts)?;
        }
        for part in parts {
            let volume = plan.volumes.get(part.volume).ok_or("it draws a volume that is not planned")?;
            if volume.winding != draw.state.winding {
                return Err("its winding is not its volume's: fronts would count as backs");
            }
            if !stencil.writes() {
                continue;
            }
            if Some(volume.light) != draw.light {
                return Err("it counts another light's volume");
            }
            let clamped = draw.state.near_plane == NearPlane::Clamp;
            if clamped != (volume.method == Method::ExactZPass) && plan.breaks != Some(Rule::ExactZPassClamps) {
                return Err("depth clamp belongs to exact z-pass, and exact z-pass needs it");
            }
            let light_cap = matches!(part.part, Part::LightCapKept | Part::LightCapTurned);
            let never = draw.state.depth.compare == Compare::Never;
            let hidden = light_cap && volume.method == Method::ZFail;
            if never != hidden && !(never && part.part == Part::DarkCap) {
                return Err(
                    "depth compare Never is for dark caps and for light caps whose surface is surely there, and for nothing else",
                );
            }
            if matches!(volume.method, Method::Dropped | Method::Projected) {
                return Err("it counts a volume that was dropped, or is none");
            }
        }
    } else if stencil.writes() {
        return check_full_screen(plan, draw, state);
    }
    Ok(())
}

/// Whether it lies over the finished picture.
const fn is_overlay(set: &DrawSet) -> bool {
    matches!(set, DrawSet::Labels(_) | DrawSet::Strokes(_))
}

/// A full-screen step that sets bits: the start of a count, its collapse, or a verdict read from wide
/// counts. It replaces, everywhere or where a count is not zero. Or it darkens by a count that it ends.
fn check_full_screen(plan: &FramePlan, draw: &Draw, state: &mut Progress) -> Result<(), &'static str> {
    if draw.set != DrawSet::FullScreen {
        return Err("only volumes are counted");
    }
    let stencil = &draw.state.stencil;
    if draw.program == Program::Dark {
        if *stencil != StencilState::reset_where_counted(plan.budget) || draw.stencil_reference != 0 {
            return Err("what darkens where a count is not zero sets it back, all of it");
        }
        if state.counted != draw.light {
            return Err("it darkens by a count that was not made");
        }
        state.counted = None;
        return Ok(());
    }
    let face = &stencil.front;
    let replaces = |op: StencilOp| op == StencilOp::Replace;
    if stencil.back != stencil.front || !replaces(face.pass) || replaces(face.fail) || replaces(face.depth_fail) {
        return Err("a full-screen step replaces where stencil and depth pass, and does nothing else");
    }
    if draw.state.depth.compare != Compare::Always {
        return Err("a full-screen step lies at infinity: depth must have no say");
    }
    match face.compare {
        Compare::Always => {}
        Compare::NotEqual if state.counted != draw.light => return Err("it collapses a count that was not made"),
        // The field must come out as zero, so that the next batch starts where it should.
        Compare::NotEqual if stencil.read_mask & !stencil.write_mask != 0 || draw.stencil_reference & stencil.read_mask != 0 => {
            return Err("it leaves a part of the count that it collapses");
        }
        Compare::NotEqual if draw.stencil_reference & stencil.write_mask == 0 => {
            return Err("it collapses a count and leaves no verdict");
        }
        Compare::NotEqual => {}
        _ => return Err("a full-screen step asks whether the count is zero, or nothing"),
    }
    state.counting = true;
    if state.counted.is_some_and(|light| Some(light) != draw.light) {
        return Err("it counts on top of another light's count");
    }
    state.counted = draw.light;
    let own = draw.stencil_reference;
    let verdict = face.compare == Compare::NotEqual || matches!(draw.program, Program::WideVerdict | Program::WideVerdictEach);
    if verdict && own.is_power_of_two() && own & plan.budget.points_mask & stencil.write_mask != 0 {
        // A verdict in a point's own bit: the field is free for the next point.
        if state.owned.insert(own, draw.light).is_some_and(|of| of != draw.light) {
            return Err("it overwrites a bit that is another light's own");
        }
        state.counted = None;
    }
    Ok(())
}

/// Whether volumes turn over a single bit that belongs to a point.
fn turns_own_bit(plan: &FramePlan, stencil: &StencilState) -> bool {
    let faces = [stencil.front, stencil.back];
    let mut ops = faces.iter().flat_map(|face| [face.fail, face.depth_fail, face.pass]);
    stencil.write_mask.is_power_of_two()
        && stencil.write_mask & plan.budget.points_mask != 0
        && ops.all(|op| matches!(op, StencilOp::Keep | StencilOp::Invert))
}

/// Surfaces that take light where bits are zero, and are marked in one of them.
fn check_once(draw: &Draw, state: &mut Progress) -> Result<(), &'static str> {
    let stencil = &draw.state.stencil;
    let bit = stencil.write_mask;
    let [front, back] = [stencil.front, stencil.back];
    let once =
        StencilFace { compare: Compare::Equal, fail: StencilOp::Keep, depth_fail: StencilOp::Keep, pass: StencilOp::Invert };
    if !bit.is_power_of_two() || stencil.read_mask & bit == 0 || draw.stencil_reference != 0 || [front, back] != [once; 2] {
        return Err("surfaces that take light are marked in one of the bits that they ask for");
    }
    match state.owned.get(&bit) {
        Some(of) if *of == draw.light => {}
        Some(_) => return Err("it shines by a bit that is another light's own"),
        None if state.counted.is_none() && stencil.read_mask == bit => _ = state.owned.insert(bit, draw.light),
        None if state.counted == draw.light && draw.light.is_some() => {}
        None => return Err("it shines by another light's count"),
    }
    state.shone |= bit;
    Ok(())
}

/// A light's bounds are marked once after the stencil was cleared, before anything is counted: what is
/// turned over twice is as it was.
fn check_bounds(plan: &FramePlan, draw: &Draw, state: &mut Progress) -> Result<(), &'static str> {
    if plan.budget.beyond_mask == 0 || draw.state.stencil != StencilState::mark_bounds(plan.budget) {
        return Err("bounds are marked in the bit that is theirs");
    }
    if draw.state.depth != Depth::NEARER || draw.state.cull != Cull::None || draw.state.near_plane != NearPlane::Clip {
        return Err("bounds are marked by both sides of a solid, where they are behind the surface");
    }
    if draw.light.is_none() || state.bounded.is_some() || state.counted.is_some() {
        return Err("bounds are marked once, before volumes are counted");
    }
    state.bounded = draw.light;
    Ok(())
}

/// A piece of a clamped volume is closed where it was cut: its sides and its caps are drawn by one step, within one window.
fn check_pieces(plan: &FramePlan, parts: &[VolumePart]) -> Result<(), &'static str> {
    for piece in parts.chunk_by(|a, b| a.volume == b.volume && a.window == b.window) {
        let volume = plan.volumes.get(piece[0].volume).ok_or("it draws a volume that is not planned")?;
        let drawn = |part: Part| piece.iter().filter(|other| other.part == part).count();
        for cap in [Part::StartCap, Part::EndCap] {
            if drawn(cap) != if volume.has(cap) { drawn(Part::Sides) } else { 0 } {
                return Err("it counts a piece of a volume that is open where it was cut, or a cap that is none of its own");
            }
        }
        if !volume.has(Part::LightCapKept) && drawn(Part::LightCapKept) + drawn(Part::LightCapTurned) > 0 {
            return Err("it counts the light cap of a piece that does not start at its caster");
        }
    }
    Ok(())
}

/// Counting by addition: z-fail, with the stencil's operations as numbers.
fn check_wide(plan: &FramePlan, draw: &Draw, state: &mut Progress) -> Result<(), &'static str> {
    let DrawSet::Volumes(parts) = &draw.set else { return Err("only volumes are counted") };
    if !state.counts_set || state.wide.is_some_and(|light| Some(light) != draw.light) {
        return Err("it counts on top of another light's count");
    }
    state.wide = draw.light;
    let State { depth, stencil, color, near_plane, .. } = draw.state;
    let asks = stencil.tests() && stencil != StencilState::within_bounds(plan.budget);
    if asks || stencil.writes() || depth.write || color != Some(Blend::Add) || near_plane != NearPlane::Clip {
        return Err("wide counts are added, under depth alone");
    }
    for part in parts {
        let volume = plan.volumes.get(part.volume).ok_or("it draws a volume that is not planned")?;
        if volume.winding != draw.state.winding {
            return Err("its winding is not its volume's: fronts would count as backs");
        }
        if Some(volume.light) != draw.light {
            return Err("it counts another light's volume");
        }
        let light_cap = matches!(part.part, Part::LightCapKept | Part::LightCapTurned);
        let everywhere = (light_cap && volume.method == Method::ZFail) || part.part == Part::DarkCap;
        if !volume.method.is_z_fail() {
            return Err("wide counts are z-fail's");
        }
        if depth.compare != if everywhere { Compare::Always } else { Compare::LessEqual } {
            return Err("wide counts take what is not nearer, dark caps, and light caps whose surface is surely there");
        }
        let turned = if part.part == Part::LightCapTurned { -1.0 } else { 1.0 };
        if draw.constant[0] != turned {
            return Err("it adds with the wrong sign");
        }
    }
    Ok(())
}
