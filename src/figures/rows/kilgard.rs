//! Kilgard 1999: reflections, planar shadows, shadow volumes, and the stencil's other uses.

use glam::DVec3;

use super::{camera, csg, look, off};
use crate::figures::{Figure, Paper};
use crate::settings::{
    Complexity, DecalMode, Diagram, Dissolve, HybridPart, LightEdit, MirrorMode, Operation, Pattern, PlanarMode, Show, Technique,
};

pub(super) static TABLE: &[Figure] = &[
    Figure {
        name: "k02a",
        paper: Paper::Kilgard,
        number: "Figure 2, left",
        title: "A constrained reflection",
        seen: "Every ray that looks down meets the floor, which reflects: nowhere can the eye look behind its plane, where the reflected things seem to stand.",
        instead: "the live scene, cut open, for a drawing",
        scene: "halo",
        view: |settings| {
            settings.show = Show::Rays;
            settings.diagram = Diagram::Mirrors;
            look(settings, [0.15, 1.5, 4.25], [0.15, 0.2, 1.6]);
        },
    },
    Figure {
        name: "k02b",
        paper: Paper::Kilgard,
        number: "Figure 2, right",
        title: "An unconstrained reflection",
        seen: "The mirror ends: some rays are turned back to the dinosaur, and others lead past the edge to behind the mirror's plane, where its reflection seems to stand.",
        instead: "the live scene, cut open, for a drawing",
        scene: "figure3",
        view: |settings| {
            settings.show = Show::Rays;
            settings.diagram = Diagram::Mirrors;
            settings.fov = Some(42.0);
            settings.time = 0.0;
            look(settings, [-2.9, 0.9, 0.02], [0.0, -0.1, 0.02]);
        },
    },
    Figure {
        name: "k03a",
        paper: Paper::Kilgard,
        number: "Figure 3, left",
        title: "A reflection kept within its mirror by the stencil",
        seen: "The dinosaur's reflection ends where the shining table ends, because only pixels tagged in the stencil take it.",
        instead: "a dinosaur of our own",
        scene: "figure3",
        view: |settings| settings.mirrors.mode = MirrorMode::Stencil,
    },
    Figure {
        name: "k03b",
        paper: Paper::Kilgard,
        number: "Figure 3, middle",
        title: "The same without the stencil",
        seen: "Nothing keeps the reflection within the table: head and shoulders stick out below its edge.",
        instead: "a dinosaur of our own",
        scene: "figure3",
        view: |settings| settings.mirrors.mode = MirrorMode::Unbounded,
    },
    Figure {
        name: "k03c",
        paper: Paper::Kilgard,
        number: "Figure 3, right",
        title: "The reflection is the object, flipped through the mirror's plane",
        seen: "Seen almost along the table, the object and what passes for its reflection stand on the two sides of a thin plane.",
        instead: "a dinosaur of our own",
        scene: "figure3",
        view: |settings| {
            settings.mirrors.mode = MirrorMode::Unbounded;
            look(settings, [-0.6, 0.16, 4.3], [0.0, 0.0, 0.0]);
        },
    },
    Figure {
        name: "k04",
        paper: Paper::Kilgard,
        number: "Figure 4",
        title: "Recursive reflections between two parallel mirrors",
        seen: "Each mirror shows the other, and in it itself, room behind room, each kept to its own pixels by a level in the stencil.",
        instead: "a barber's shop of our own",
        scene: "barbershop",
        view: |_| {},
    },
    Figure {
        name: "k05",
        paper: Paper::Kilgard,
        number: "Figure 5",
        title: "Bird's eye view of the reflected rooms",
        seen: "The rooms that the mirrors make, where they seem to stand; the lines bound what the eye sees of each. The real room is the light one in the middle.",
        instead: "",
        scene: "barbershop",
        view: |settings| settings.show = Show::Birdseye,
    },
    Figure {
        name: "k06",
        paper: Paper::Kilgard,
        number: "Figure 6",
        title: "Planar shadows, blended twice",
        seen: "Where the dinosaur's projected triangles lie over one another the floor is darkened twice: dark patches that jump when it moves.",
        instead: "a dinosaur of our own",
        scene: "figure7",
        view: |settings| {
            settings.planar.mode = PlanarMode::Naive;
            look(settings, [0.7, 1.9, 2.3], [0.1, 0.25, 0.0]);
        },
    },
    Figure {
        name: "k07a",
        paper: Paper::Kilgard,
        number: "Figure 7, left",
        title: "A shadow in mid-air",
        seen: "Nothing keeps the projected shadow on the tile: it goes on beyond the edge, and is blended twice where triangles overlap.",
        instead: "a dinosaur of our own",
        scene: "figure7",
        view: |settings| {
            settings.planar.mode = PlanarMode::Naive;
        },
    },
    Figure {
        name: "k07b",
        paper: Paper::Kilgard,
        number: "Figure 7, right",
        title: "The same with the stencil",
        seen: "The shadow ends with the tile, and every pixel of it is darkened once.",
        instead: "a dinosaur of our own",
        scene: "figure7",
        view: |settings| {
            settings.planar.mode = PlanarMode::StencilBlend;
        },
    },
    Figure {
        name: "k08",
        paper: Paper::Kilgard,
        number: "Figure 8",
        title: "A slice through a shadow volume",
        seen: "The slab's shadow volume, swept away from the lamp without end: of the ball, what lies within is in shadow, what lies outside is lit, wherever the eye is.",
        instead: "the live scene, cut open, for a drawing",
        scene: "slice",
        view: |settings| {
            settings.show = Show::Rays;
            settings.diagram = Diagram::Slice;
        },
    },
    Figure {
        name: "k09a",
        paper: Paper::Kilgard,
        number: "Figure 9, left",
        title: "The shadow volume of a cut-out",
        seen: "The letters' outline, swept away from the lamp: what lies within is in shadow.",
        instead: "a slab with our own name for the NVIDIA logo",
        scene: "teapots",
        view: |settings| {
            settings.show = Show::Volumes;
            settings.technique = Technique::Cutout;
        },
    },
    Figure {
        name: "k09b",
        paper: Paper::Kilgard,
        number: "Figure 9, right",
        title: "What the volume shadows",
        seen: "The letters fall on the floor, on round balls and on the teapots alike: a volume needs no flat receiver.",
        instead: "a slab with our own name for the NVIDIA logo",
        scene: "teapots",
        view: |settings| settings.technique = Technique::Cutout,
    },
    Figure {
        name: "k10",
        paper: Paper::Kilgard,
        number: "Figure 10",
        title: "Counting enters and leaves",
        seen: "Each ray counts one more where it enters the volume and one less where it leaves; where it ends on a surface with 0, that is lit.",
        instead: "the live scene, cut open, for a drawing",
        scene: "slice",
        view: |settings| {
            settings.show = Show::Rays;
        },
    },
    Figure {
        name: "k11",
        paper: Paper::Kilgard,
        number: "Figure 11",
        title: "shadowfun",
        seen: "Two lamps throw every toy on the wall twice; silhouettes are flattened into cut-outs each frame, as his program did it.",
        instead: "toys of our own",
        scene: "shadowfun",
        view: |settings| settings.technique = Technique::Flattened,
    },
    Figure {
        name: "k12a",
        paper: Paper::Kilgard,
        number: "Figure 12, left",
        title: "hello2rts",
        seen: "Solid letters throw overlapping shadows on each other and on balls, in two lights of two colours.",
        instead: "letters and balls of our own",
        scene: "hello2rts",
        view: |_| {},
    },
    Figure {
        name: "k12b",
        paper: Paper::Kilgard,
        number: "Figure 12, right",
        title: "hello2rts from the side",
        seen: "Where both shadows fall on each other only ambient light is left; where one falls, the other lamp's colour shows.",
        instead: "letters and balls of our own",
        scene: "hello2rts",
        view: |settings| camera(settings, "left"),
    },
    Figure {
        name: "k13",
        paper: Paper::Kilgard,
        number: "Figure 13",
        title: "Counting several volumes",
        seen: "Three volumes overlap: each that a ray enters is one more, each that it leaves one less. 0 is outside of all of them, and lit.",
        instead: "the live scene, cut open, for a drawing",
        scene: "slabs",
        view: |settings| {
            settings.show = Show::Rays;
        },
    },
    Figure {
        name: "k14a",
        paper: Paper::Kilgard,
        number: "Figure 14, top",
        title: "Volumes and planar shadows together",
        seen: "The rosette throws a shadow volume, on the dinosaur's back as on floor and board; the dinosaur's and the balls' own shadows are projected.",
        instead: "a rosette and a dinosaur of our own for the NVIDIA logo and the teapot",
        scene: "figure7",
        view: |settings| {
            settings.planar.mode = PlanarMode::Hybrid;
        },
    },
    Figure {
        name: "k14b",
        paper: Paper::Kilgard,
        number: "Figure 14, left",
        title: "Volumes alone",
        seen: "The rosette falls on everything, but dinosaur and balls throw no shadow.",
        instead: "a rosette and a dinosaur of our own for the NVIDIA logo and the teapot",
        scene: "figure7",
        view: |settings| {
            settings.planar.mode = PlanarMode::Hybrid;
            settings.planar.hybrid = HybridPart::Volumes;
        },
    },
    Figure {
        name: "k14c",
        paper: Paper::Kilgard,
        number: "Figure 14, right",
        title: "Planar shadows alone",
        seen: "Dinosaur and balls throw their shadows on floor and board, but nothing falls on the dinosaur.",
        instead: "a rosette and a dinosaur of our own for the NVIDIA logo and the teapot",
        scene: "figure7",
        view: |settings| {
            settings.planar.mode = PlanarMode::Hybrid;
            settings.planar.hybrid = HybridPart::Planar;
        },
    },
    Figure {
        name: "k15",
        paper: Paper::Kilgard,
        number: "Figure 15",
        title: "Soft shadows from many shadow volumes",
        seen: "A lamp with a size is counted as eight points: the shadow's rim goes to light in bands, one for each of them.",
        instead: "a slide projector's room of our own",
        scene: "projector",
        view: |settings| {
            settings.lighting.area_samples = 8;
            off(settings, 0);
            let (position, intensity) = (Some(DVec3::new(-1.6, 1.5, 1.6)), Some(34.0));
            settings.lights.insert(1, LightEdit { position, intensity, radius: Some(0.22), ..LightEdit::default() });
        },
    },
    Figure {
        name: "k16",
        paper: Paper::Kilgard,
        number: "Figure 16",
        title: "A dissolve by a stencil pattern",
        seen: "Half the pixels, marked in the stencil by a pattern, show the picture without shadows, the others the one with them.",
        instead: "one scene with and without shadows for his two scenes",
        scene: "courtyard",
        view: |settings| {
            settings.dissolve = Dissolve { into: Some(Technique::None), pattern: Pattern::BlueNoise, ..Dissolve::default() };
        },
    },
    Figure {
        name: "k17",
        paper: Paper::Kilgard,
        number: "Figure 17",
        title: "A magic halo, with reflection and shadow",
        seen: "The glow surrounds its objects and never covers them, no pixel glows twice, the floor reflects objects and glow, and the column hides the ring's.",
        instead: "a pilgrim, a ring and an orb for his sphere",
        scene: "halo",
        view: |_| {},
    },
    Figure {
        name: "k18a",
        paper: Paper::Kilgard,
        number: "Figure 18, left",
        title: "Coplanar geometry, fighting",
        seen: "Runway, markings and the aeroplane's shadow lie in one plane, and depth's last bits decide between them by chance.",
        instead: "a runway and an aeroplane of our own",
        scene: "runway",
        view: |settings| {
            settings.decals = DecalMode::ZFighting;
        },
    },
    Figure {
        name: "k18b",
        paper: Paper::Kilgard,
        number: "Figure 18, right",
        title: "The same by the stencil",
        seen: "Each layer claims its pixels of the ground in the stencil: no offset, no chance.",
        instead: "a runway and an aeroplane of our own",
        scene: "runway",
        view: |settings| {
            settings.decals = DecalMode::Stencil;
        },
    },
    Figure {
        name: "k19a",
        paper: Paper::Kilgard,
        number: "Figure 19, upper left",
        title: "A or B",
        seen: "The ball and the knot as one solid, in one shadow.",
        instead: "a ball and a knot of our own",
        scene: "csg",
        view: |settings| csg(settings, Operation::Union),
    },
    Figure {
        name: "k19b",
        paper: Paper::Kilgard,
        number: "Figure 19, upper right",
        title: "A and B",
        seen: "Only what lies in both is left: pieces of the knot, with caps of the ball's surface.",
        instead: "a ball and a knot of our own",
        scene: "csg",
        view: |settings| csg(settings, Operation::Intersection),
    },
    Figure {
        name: "k19c",
        paper: Paper::Kilgard,
        number: "Figure 19, lower left",
        title: "A minus B",
        seen: "The knot has left its bed in the ball: its inside is seen there, in its own colour, in light and shadow.",
        instead: "a ball and a knot of our own",
        scene: "csg",
        view: |settings| csg(settings, Operation::AMinusB),
    },
    Figure {
        name: "k19d",
        paper: Paper::Kilgard,
        number: "Figure 19, lower right",
        title: "B minus A",
        seen: "What of the knot lies outside the ball, cut off along the ball's surface, whose inside shows at the cuts.",
        instead: "a ball and a knot of our own",
        scene: "csg",
        view: |settings| csg(settings, Operation::BMinusA),
    },
    Figure {
        name: "k20a",
        paper: Paper::Kilgard,
        number: "Figure 20, left",
        title: "A dinosaur, drawn normally",
        seen: "What is to be counted in the picture beside it.",
        instead: "a dinosaur of our own",
        scene: "figure3",
        view: |settings| {
            settings.mirrors.mode = MirrorMode::Off;
            look(settings, [1.3, 1.3, 2.6], [0.05, 0.65, 0.0]);
        },
    },
    Figure {
        name: "k20b",
        paper: Paper::Kilgard,
        number: "Figure 20, right",
        title: "Its depth complexity",
        seen: "How many fragments fall on each pixel, hidden ones too, counted in the stencil and shown in false colour.",
        instead: "a dinosaur of our own",
        scene: "figure3",
        view: |settings| {
            settings.mirrors.mode = MirrorMode::Off;
            settings.show = Show::Complexity;
            settings.complexity = Complexity::Fragments;
            look(settings, [1.3, 1.3, 2.6], [0.05, 0.65, 0.0]);
        },
    },
];
