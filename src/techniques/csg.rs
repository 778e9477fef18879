//! Two solids put together, drawn by counting (K section 7, figure 19; Goldfeather, Molnar, Turk and Fuchs 1989,
//! Wiegand 1996), for closed meshes of any shape.
//!
//! What is seen of the result are pieces of A's surface and of B's. Which pieces, the operation says:
//!
//! ```text
//!   A or B         A's front outside B,   B's front outside A
//!   A and B        A's front inside B,    B's front inside A
//!   A minus B      A's front outside B,   B's back inside A
//! ```
//!
//! A pixel may meet the same side of a hollow object several times. Each of these *layers* is looked at by itself, in a
//! target of the solid's own: of the pixel's fragments only the one whose number is asked for leaves its depth, the
//! stencil counting them as they arrive. Then every face of the other operand that lies behind that depth turns one bit
//! over: an odd number means inside, from wherever the eye looks, for it is counted from infinity, as z-fail does. Layers
//! on the right side go into the scene's depth, the nearest of all wins; and what is drawn after finds itself by its own
//! depth, lights, shadows and all.
//!
//! How many layers there are at most is told from the triangles ([`crate::geometry::layers`]). Where they are more than
//! the stencil's bits tell apart, the triangles are drawn in parts: a part has fewer layers, and it does not matter in
//! how many parts the pieces come.

use std::ops::Range;

use glam::DMat4;

use super::surfaces::{Known, Place};
use crate::frame::plan::View;
use crate::frame::state::{Cull, Depth, NearPlane, State, Winding};
use crate::frame::stencil::{StencilState, most_layers};
use crate::frame::{Draw, DrawSet, Look, Program, Run, Step, Surface, Target};
use crate::geometry::frustum::screen_rect;
use crate::geometry::layers::{Side, layers};
use crate::geometry::pixels::common;
use crate::scene::{Mesh, Solid};
use crate::settings::Operation;

/// Which pieces of one operand's surface are seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Piece {
    /// Of A; else of B.
    of_a: bool,
    /// Its front; else its back.
    front: bool,
    /// What lies in the other operand; else what lies outside.
    inside: bool,
}

const fn pieces(operation: Operation) -> [Piece; 2] {
    match operation {
        Operation::Off | Operation::Union => [piece(true, true, false), piece(false, true, false)],
        Operation::Intersection => [piece(true, true, true), piece(false, true, true)],
        Operation::AMinusB => [piece(true, true, false), piece(false, false, true)],
        Operation::BMinusA => [piece(false, true, false), piece(true, false, true)],
    }
}

const fn piece(of_a: bool, front: bool, inside: bool) -> Piece {
    Piece { of_a, front, inside }
}

/// One operand in one view.
struct Operand<'a> {
    name: &'static str,
    mesh: &'a Mesh,
    instance: usize,
    winding: Winding,
    clip_from_object: DMat4,
    clipped: bool,
    /// The pixels that may show it; none where it is out of view.
    rect: Option<[u32; 4]>,
}

/// The steps that lay the solid's depth in a view; and what a user should know of them. `bits` are the stencil's that may
/// count, `samples` the scene's.
#[must_use]
pub fn steps(known: Known<'_>, view: &View, solid: &Solid, bits: u32, samples: u32) -> (Vec<Step>, Vec<String>) {
    let (mut steps, mut notes) = (Vec::new(), Vec::new());
    let operands = [(solid.a, "A"), (solid.b, "B")].map(|(instance, name)| operand(known, view, instance, name));
    let [Some(a), Some(b)] = operands else { return (steps, notes) };
    for piece in pieces(solid.of.operation) {
        let (target, other) = if piece.of_a { (&a, &b) } else { (&b, &a) };
        // What is inside the other is where the other is.
        let rect = if piece.inside { target.rect.zip(other.rect).and_then(|(a, b)| common(a, b)) } else { target.rect };
        let Some(rect) = rect else { continue };
        let parts = parts(target, view, piece.front, rect, most_layers(bits));
        if parts.len() > 1 {
            let count = parts.len();
            notes.push(format!(
                "{} is drawn in {count} parts: it has more layers than {bits} bits of the stencil tell apart",
                target.name
            ));
        }
        for (part, rects) in &parts {
            for (layer, rect) in rects.iter().enumerate() {
                let label = format!("{}, {}: layer {} of {}", target.name, piece.words(), layer + 1, rects.len());
                let layer = u8::try_from(layer).unwrap_or(u8::MAX);
                steps.extend(draw_layer((target, other), (piece, &label), part.clone(), (layer, *rect), (bits, samples)));
            }
        }
    }
    (steps, notes)
}

impl Piece {
    const fn words(self) -> &'static str {
        match (self.front, self.inside) {
            (true, false) => "front outside",
            (true, true) => "front inside",
            (false, false) => "back outside",
            (false, true) => "back inside",
        }
    }
}

fn operand<'a>(known: Known<'a>, view: &View, instance: usize, name: &'static str) -> Option<Operand<'a>> {
    let (node, _, mesh) = known.scene.instances().nth(instance)?;
    let world_from_object = known.pose.world_from_object[node];
    let clip_from_world = view.camera.clip_from_world();
    let bounds = known.pose.world_bounds(known.scene, node);
    let rect = screen_rect(bounds.center().as_dvec3(), f64::from(bounds.radius()), &clip_from_world, view.picture);
    let rect = rect.and_then(|rect| common(rect, view.rect)).filter(|_| known.places[instance] != Place::Unseen);
    Some(Operand {
        name,
        mesh,
        instance,
        winding: view.winding.through(world_from_object.matrix3.determinant()),
        clip_from_object: clip_from_world * DMat4::from(world_from_object),
        clipped: known.places[instance] == Place::Across,
        rect,
    })
}

/// Parts of an operand's triangles that each have at most so many layers, with the pixels of each layer.
fn parts(operand: &Operand<'_>, view: &View, front: bool, rect: [u32; 4], most: usize) -> Vec<(Range<usize>, Vec<[u32; 4]>)> {
    let side = Side { counter_clockwise: (operand.winding == Winding::Ccw) == front };
    let Operand { mesh, clip_from_object, .. } = operand;
    let corner = |&vertex: &u32| mesh.positions[vertex as usize].as_dvec3().extend(1.0);
    let mut parts = Vec::new();
    let mut waiting = Vec::from([Range { start: 0, end: mesh.indices.len() / 3 }]);
    while let Some(part) = waiting.pop() {
        let corners = mesh.indices[part.start * 3..part.end * 3].as_chunks::<3>().0;
        let corners = corners.iter().map(|triangle| triangle.each_ref().map(corner));
        let rects = layers(corners, clip_from_object, view.camera.near, view.picture, rect, side);
        if rects.len() > most && part.len() > 1 {
            let middle = part.start + part.len() / 2;
            waiting.extend([middle..part.end, part.start..middle]);
        } else if !rects.is_empty() {
            parts.push((part, rects));
        }
    }
    parts
}

fn draw_layer(
    (target, other): (&Operand<'_>, &Operand<'_>),
    (piece, label): (Piece, &str),
    part: Range<usize>,
    (layer, rect): (u8, [u32; 4]),
    (bits, samples): (u32, u32),
) -> [Step; 4] {
    let begin = Draw {
        target: Target::Solid,
        state: State { depth: Depth::OVERWRITE, stencil: StencilState::solid_begin(), ..State::FLAT },
        ..Draw::plain(Program::StencilOnly, DrawSet::FullScreen, rect)
    };
    let lay = Draw {
        state: State {
            depth: Depth::OVERWRITE,
            stencil: StencilState::solid_layer(bits),
            color: None,
            cull: if piece.front { Cull::Back } else { Cull::Front },
            winding: target.winding,
            near_plane: NearPlane::Clip,
        },
        stencil_reference: layer,
        ..surfaces(target, part, rect)
    };
    let whole = 0..other.mesh.indices.len() / 3;
    let count = surfaces(other, whole, rect);
    let stencil = StencilState::solid_parity();
    let state = State { depth: Depth::NEARER, stencil, cull: Cull::None, winding: other.winding, ..State::FLAT };
    // The other operand is there behind a mirror's plane too: it is counted, not seen.
    let count = Draw { program: Program::Depth, look: Look::default(), state, ..count };
    let merge = Draw {
        state: State { depth: Depth::LAY, ..State::FLAT },
        constant: [if piece.inside { 1.0 } else { 0.0 }, 0.0, 0.0, 0.0],
        ..Draw::plain(if samples == 1 { Program::SolidMerge } else { Program::SolidMergeEach }, DrawSet::FullScreen, rect)
    };
    [
        Step::drawing(format!("{label}: begin"), "The solid's own target: depth to infinity, no bit set.", begin),
        Step::drawing(
            label,
            "Of each pixel's fragments the one of this number leaves its depth; the stencil counts them as they come.",
            lay,
        ),
        Step::drawing(
            format!("{label}: behind it"),
            "Each face of the other operand behind the layer turns one bit over: an odd number is inside.",
            count,
        ),
        Step::drawing(
            format!("{label}: merge"),
            "Where the layer lies on the right side of the other operand it is the solid's: the nearest is kept.",
            merge,
        ),
    ]
}

/// Some of an operand's triangles, for their depth alone.
fn surfaces(operand: &Operand<'_>, part: Range<usize>, rect: [u32; 4]) -> Draw {
    let clipped = operand.clipped;
    let program = if clipped { Program::DepthMasked } else { Program::Depth };
    let set = DrawSet::Runs(runs(operand, part));
    Draw { target: Target::Solid, look: Look { clipped, ..Look::default() }, ..Draw::plain(program, set, rect) }
}

/// Triangles by their number in the mesh, primitive by primitive.
fn runs(operand: &Operand<'_>, part: Range<usize>) -> Vec<Run> {
    let of_primitive = |(primitive, run): (usize, &crate::scene::Primitive)| {
        let (first, count) = (run.first_index as usize / 3, run.index_count as usize / 3);
        let (from, to) = (part.start.max(first), part.end.min(first + count));
        let number = |at: usize| u32::try_from(at - first).unwrap_or(u32::MAX);
        let surface = Surface { instance: operand.instance, primitive };
        (from < to).then(|| Run { surface, triangles: [number(from), number(to)] })
    };
    operand.mesh.primitives.iter().enumerate().filter_map(of_primitive).collect()
}
