//! Magic halos (K section 7, figure 17): a glow about an object that never covers it.
//!
//! K draws the object with a tag, and then an enlarged copy in the glow's colour wherever the tag is not; concave
//! objects he would break into convex pieces, each enlarged about its own middle. Here every vertex is moved outwards
//! by so many pixels instead, along the mean of the normals about it ([`crate::geometry::outward`]), and that does for
//! any shape.
//!
//! ```text
//!   tag      all of the object's pixels, hidden or not
//!   shell 1  the copy swollen least, brightest: where nothing is tagged and nothing glows yet; counts itself
//!   ...
//!   shell n  the widest, faintest
//! ```
//!
//! A pixel takes the first shell that reaches it and no other, so no copy is blended over another, nor over itself: K's
//! "use stenciling to avoid double blending". Shells are drawn nearer than they are by three times their width:
//! before the floor that the object stands on, and behind what stands well before it.
//!
//! Two solids put together ([`super::csg`]) are one object: what swells is the mesh that casts their shadow,
//! or would if they cast any; where the library made none the plan says so.

use glam::Vec3;

use super::surfaces::SurfaceGroup;
use crate::frame::state::{Blend, Cull, Depth, NearPlane, State, Winding};
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{Draw, DrawSet, Look, Program, Step, Surface, Swollen};
use crate::scene::solid::Solid;
use crate::settings::Operation;

/// How a view's halos look.
#[derive(Debug, Clone, Copy)]
pub struct Glow {
    /// Linear RGB, as it comes out of the tone curve.
    pub color: Vec3,
    /// Pixels from the object's outline to its end.
    pub pixels: f32,
    /// The picture's.
    pub exposure: f32,
}

/// Of the glow at the outline: how much of what lies behind it covers.
const DENSEST: f32 = 0.9;

/// What glows in a view.
#[derive(Debug)]
pub struct Glowing {
    /// Tagged wherever they are, and swollen.
    whole: Vec<SurfaceGroup>,
    /// Tagged where they are seen: the operands of a solid, of which only parts are left.
    seen: Vec<SurfaceGroup>,
}

impl Glowing {
    /// Those surfaces of `groups` whose instances are `chosen`. Two solids put together glow as one, which `mesh` is; where
    /// no mesh could be made of them they do not.
    #[must_use]
    pub fn new(groups: &[SurfaceGroup], chosen: &[bool], solid: Option<&Solid>, mesh: Option<SurfaceGroup>) -> Self {
        let only = |wanted: &dyn Fn(usize) -> bool| {
            let of_group = |group: &SurfaceGroup| {
                let surfaces = group.surfaces.iter().copied().filter(|surface| wanted(surface.instance)).collect();
                SurfaceGroup { kind: group.kind, surfaces }
            };
            groups.iter().map(of_group).filter(|group| !group.surfaces.is_empty()).collect::<Vec<_>>()
        };
        let Some(solid) = solid else {
            return Self { whole: only(&|instance| chosen[instance]), seen: Vec::new() };
        };
        let operand = |instance| instance == solid.a || instance == solid.b;
        let glows = chosen[solid.a] || chosen[solid.b];
        // All of both is left of either: their outlines are the union's.
        if solid.of.operation == Operation::Union {
            return Self { whole: only(&|instance| if operand(instance) { glows } else { chosen[instance] }), seen: Vec::new() };
        }
        let mut whole = only(&|instance| !operand(instance) && chosen[instance]);
        whole.extend(mesh.filter(|_| glows));
        Self { whole, seen: only(&|instance| operand(instance) && glows) }
    }
}

/// Tag and shells of what glows; nothing where nothing does.
#[must_use]
pub fn steps(glowing: &Glowing, glow: Glow, budget: BitBudget, scissor: [u32; 4]) -> Vec<Step> {
    let Glowing { whole: groups, seen } = glowing;
    if groups.is_empty() {
        return Vec::new();
    }
    let mut steps: Vec<_> = groups.iter().map(|group| tag(group, Depth::IGNORE, budget, scissor)).collect();
    steps.extend(seen.iter().map(|group| tag(group, Depth::SAME_SURFACE, budget, scissor)));
    // One call for what is clipped at a mirror's plane, and one for what is not.
    let copies = [false, true].map(|clipped| {
        let alike = groups.iter().filter(|group| group.kind.look.clipped == clipped);
        (clipped, alike.flat_map(|group| group.surfaces.iter().copied()).collect::<Vec<_>>())
    });
    let shells = shells(glow.pixels);
    for shell in 0..shells {
        for (clipped, surfaces) in copies.iter().filter(|(_, surfaces)| !surfaces.is_empty()) {
            steps.push(draw_shell((shell, shells), (surfaces, *clipped), glow, budget, scissor));
        }
    }
    steps
}

/// So many that none is wider than a pixel and a half, as far as that goes.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number that is not negative")]
fn shells(pixels: f32) -> u32 {
    ((pixels / 1.5).ceil() as u32).clamp(4, 20)
}

fn tag(group: &SurfaceGroup, depth: Depth, budget: BitBudget, scissor: [u32; 4]) -> Step {
    let draw = group.depth_draw(depth, StencilState::tag_halo(budget), scissor);
    let hidden_too = depth == Depth::IGNORE;
    let state = State { cull: if hidden_too { Cull::None } else { draw.state.cull }, ..draw.state };
    let why = if hidden_too {
        "Tags all pixels of what has a halo, hidden ones too: no halo will cover them."
    } else {
        "Tags what is seen of two solids put together, to the very pixel: their mesh was rounded otherwise."
    };
    let label = format!("tag for halos{}", group.words());
    Step::drawing(label, why, Draw { state, stencil_reference: budget.halo_tag(), ..draw })
}

fn draw_shell(
    (shell, shells): (u32, u32),
    (surfaces, clipped): (&[Surface], bool),
    glow: Glow,
    budget: BitBudget,
    scissor: [u32; 4],
) -> Step {
    #[expect(clippy::cast_precision_loss, reason = "twenty at most")]
    let (inner, outer) = (shell as f32 / shells as f32, (shell + 1) as f32 / shells as f32);
    let alpha = DENSEST * (1.0 - inner).powf(2.0);
    // The tone curve comes after.
    let color = glow.color * (alpha / glow.exposure);
    let state = State {
        depth: Depth::ON_OR_NEARER,
        stencil: StencilState::glow_once(budget),
        color: Some(Blend::Over),
        cull: Cull::None,
        winding: Winding::Ccw,
        near_plane: NearPlane::Clip,
    };
    let set = DrawSet::Swollen(Swollen { surfaces: surfaces.to_vec(), pixels: glow.pixels * outer });
    let draw = Draw {
        look: Look { clipped, ..Look::default() },
        state,
        constant: color.extend(alpha).to_array(),
        ..Draw::plain(Program::Halo, set, scissor)
    };
    let why = "A copy swollen by so many pixels, where neither an object is tagged nor a shell within this one glows: each pixel glows once.";
    let words = if clipped { ", clipped" } else { "" };
    Step::drawing(format!("halo {} of {shells}{words}", shell + 1), why, draw)
}
