//! The failures themselves, in the order of [`Failure::ALL`].

use glam::DVec3;

use super::{Row, spoil};
use crate::settings::{CameraChoice, Failure, LightEdit, Settings, Technique};

/// From here to there.
fn look(settings: &mut Settings, eye: [f64; 3], target: [f64; 3]) {
    settings.camera = CameraChoice::Free { eye: DVec3::from(eye), target: DVec3::from(target) };
}

/// Without this light, so that nothing hides what another does.
fn off(settings: &mut Settings, light: usize) {
    settings.lights.insert(light, LightEdit { on: Some(false), ..LightEdit::default() });
}

/// Every failure, in the order of [`Failure::ALL`].
pub static TABLE: [Row; 13] = [
    Row {
        failure: Failure::EyeInShadow,
        title: "Eye in shadow",
        seen: "Light and shadow change places wherever the disc's shadow ends before the surface that is seen.",
        why: "Z-pass counts from 0 at the eye, but the eye is inside a volume already: all counts are one too low, and where the ray leaves the volume 0 becomes -1.",
        cure: "Count behind the surface (z-fail), or start from the number of volumes that hold the eye (exact z-pass, ZP+).",
        source: "McGuire et al. 2003, 3; CSCI 4229, Z-Pass Pros and Cons; Kilgard 1999, 6.2.3",
        technique: Technique::ZPass,
        scene: "eye-in-shadow",
        view: |_| {},
        spoil: spoil::nothing,
    },
    Row {
        failure: Failure::NearPlane,
        title: "Near plane through a volume",
        seen: "A straight border runs through the picture, and on one side of it what is lit is drawn dark.",
        why: "The count at the eye is right, but the near plane cuts the side of a volume open between the eye and a part of the picture, and what is clipped is not counted: one number cannot stand for a whole rectangle.",
        cure: "Clamp depth, so that the near plane clips nothing (exact z-pass), draw the near plane's own counts (ZP+), or count behind the surface (z-fail).",
        source: "McGuire et al. 2003, 3; Kilgard 1999, 6.2.3; CSCI 4229, Z-Pass Pros and Cons",
        technique: Technique::ExactZPass,
        scene: "eye-in-shadow",
        view: |settings| {
            look(settings, [1.57, 1.55, 6.2], [0.48, 2.0, -3.0]);
            off(settings, 1);
        },
        spoil: spoil::clip_at_near_plane,
    },
    Row {
        failure: Failure::FiniteFar,
        title: "Finite far plane",
        seen: "Far shadows are gone, and shadows that nothing throws lie over lit ground in front.",
        why: "Z-fail counts the faces behind the surface, and those beyond the far plane are clipped: rays that enter a volume there, or leave it, are miscounted, which is the near plane's failure moved to the back.",
        cure: "Put the far plane at infinity (a projection with w = 0 for what is infinitely far), or end the volumes before it.",
        source: "McGuire et al. 2003, 3; CSCI 4229, Fixing Z-Pass",
        technique: Technique::ZFail,
        scene: "cubes",
        view: |_| {},
        spoil: spoil::put_far_plane,
    },
    Row {
        failure: Failure::NoLightCap,
        title: "Missing light cap",
        seen: "Whatever casts a shadow is dark on its lit side too, and so is what stands before it.",
        why: "Z-fail counts rays from infinity that must enter and leave a closed volume, and those that leave it through the caster's own lit surface find no face there.",
        cure: "Draw the light-facing triangles as the volume's cap whenever counting is by z-fail.",
        source: "McGuire et al. 2003, 6; Lengyel 2002, Rendering Shadow Volumes; Beam 2004, Shadow Volumes",
        technique: Technique::ZFail,
        scene: "cubes",
        view: |_| {},
        spoil: spoil::drop_light_caps,
    },
    Row {
        failure: Failure::NoDarkCap,
        title: "Missing dark cap",
        seen: "Shadows are gone but for their outlines, and what stands before a volume is dark.",
        why: "The far end of the volume is open, so rays that should enter it there are never counted in.",
        cure: "Close the volume away from the light, at infinity or behind everything; only a directional light's volume closes itself, in one point.",
        source: "McGuire et al. 2003, 6; Lengyel 2002, Rendering Shadow Volumes",
        technique: Technique::ZFail,
        scene: "cubes",
        view: |_| {},
        spoil: spoil::drop_dark_caps,
    },
    Row {
        failure: Failure::DarkCapFan,
        title: "Dark cap as a fan all around the light",
        seen: "The lamp in the hut shines through its walls, and not through its door.",
        why: "A fan over the silhouette closes the smaller side of it, but where the caster stands on all sides of the light its shadow is the larger side: all counts are one off.",
        cure: "Use the fan only where everything the light sees of the caster lies within a half-space, else throw every light-facing triangle to infinity.",
        source: "McGuire et al. 2003, 6 (dark caps; triangles of more than 180 degrees)",
        technique: Technique::ZFail,
        scene: "hut",
        view: |_| {},
        spoil: spoil::fan_across,
    },
    Row {
        failure: Failure::Saturating,
        title: "Counting that saturates",
        seen: "Sides of cubes and walls that are in full light are dark, and the dark stays where volumes overlap.",
        why: "The triangles arrive in no order, so a count may have to go below 0 before it comes back, and decrementing that stops at 0 loses what it should have taken away.",
        cure: "Increment and decrement with wrapping, which forgives any order, or draw all that increments before all that decrements.",
        source: "Lengyel 2002, Rendering Shadow Volumes; Kilgard 1999, 1 (wrapping operations)",
        technique: Technique::ZFail,
        scene: "grid",
        view: |settings| {
            settings.camera = CameraChoice::Named("inside".into());
            off(settings, 1);
        },
        spoil: spoil::clamp_counts,
    },
    Row {
        failure: Failure::StencilOverflow,
        title: "Stencil overflow",
        seen: "Light lies at the foot of the stairs, where the shadow is deepest.",
        why: "Eight bits count to 255, and a surface in the shadow of exactly 256 casters has the count of one in no shadow.",
        cure: "Bound the count, and where it may overflow collapse batches of casters into one bit or count in a wider target.",
        source: "McGuire et al. 2003, 4 and image 3",
        technique: Technique::ZFail,
        scene: "stairs",
        view: |_| {},
        spoil: spoil::nothing,
    },
    Row {
        failure: Failure::OpenMesh,
        title: "Closed-mesh silhouettes on an open mesh",
        seen: "The teapots are dark where the lamp shines on them, in patches that end in straight lines.",
        why: "Where an edge has only one triangle the rule for closed meshes finds no silhouette, and triangles that face away cast nothing: the volume has holes.",
        cure: "Close the mesh, or count every triangle, turned to face the light, and let each edge carry its signed multiplicity.",
        source: "McGuire et al. 2003, 4; Kilgard 1999, 6.2.3; CSCI 4229, Z-Pass Pros and Cons",
        technique: Technique::ZFail,
        scene: "teapots",
        view: |settings| {
            look(settings, [0.9, 1.5, 2.2], [0.85, 0.5, -1.0]);
            off(settings, 1);
        },
        spoil: spoil::assume_closed,
    },
    Row {
        failure: Failure::TJunction,
        title: "T-junctions",
        seen: "Dotted lines of light run through the awning's shadow, under its seams.",
        why: "A corner in the middle of another triangle's edge never lies on it exactly, so the two volumes' sides leave gaps between them, which the shadow enlarges.",
        cure: "Let both sides of an edge have the same vertices: divide the long triangle at the corner it meets.",
        source: "McGuire et al. 2003, 4; Kilgard 1999, 6.3 (cracks)",
        technique: Technique::ZFail,
        scene: "awning",
        view: |_| {},
        spoil: spoil::forget_vertices,
    },
    Row {
        failure: Failure::CoarseVolume,
        title: "A coarser mesh for the volume",
        seen: "Dark facets lie on what is lit, the letters' shadow is a lump, and round things throw shadows with corners.",
        why: "The volume is made of fewer triangles than the surface, so it pokes through it, and the shadow, larger than the caster, enlarges every corner.",
        cure: "Build the volume from the very triangles that are drawn.",
        source: "Kilgard 1999, 6.2.2",
        technique: Technique::ZFail,
        scene: "teapots",
        view: |settings| off(settings, 1),
        spoil: spoil::coarsen,
    },
    Row {
        failure: Failure::MismatchedArithmetic,
        title: "Mismatched vertex arithmetic",
        seen: "Lit surfaces of casters are speckled with shadow.",
        why: "Light cap and surface are the same triangles, but their positions are computed by products that are equal only in mathematics: in the last bits one is before the other by chance.",
        cure: "Compute both by one function that the compiler may not vary, and draw light caps whose surface is surely there with a depth test that never passes.",
        source: "this project (DESIGN 3); Lengyel 2002, Rendering Shadow Volumes",
        technique: Technique::ZFail,
        scene: "courtyard",
        view: |settings| look(settings, [4.15, 0.7, 1.25], [4.15, 0.55, 0.6]),
        spoil: spoil::mismatch,
    },
    Row {
        failure: Failure::PolygonOffset,
        title: "Polygon offset on the volume",
        seen: "Shadows have moved off the things that throw them, and hang over their own edges.",
        why: "An offset that is meant against speckles moves the volume's faces through all surfaces near them, by more the more obliquely they are seen.",
        cure: "Give volumes and surfaces the same positions to the last bit, and offset neither.",
        source: "Kilgard 1999, 6.2.3; Beam 2004, Stencil Operations and Rendering",
        technique: Technique::ZFail,
        scene: "cubes",
        view: |_| {},
        spoil: spoil::offset,
    },
];
