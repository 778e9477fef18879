//! The built-in scenes, composed from the models in `assets/`, one file each.

mod barbershop;
mod carpentry;
mod cathedral;
mod compose;
mod corridor;
mod courtyard;
mod csg;
mod cubes;
mod demonstrations;
mod eye_in_shadow;
mod figure3;
mod figure7;
mod gallery;
mod grid;
mod halo;
mod hello2rts;
mod kaleidoscope;
mod portals;
mod projector;
mod runway;
mod shadowfun;
mod slices;
mod stairs;
mod teapots;
mod terraces;
#[cfg(test)]
mod tests;

use super::Scene;
use super::gltf::ImportError;

/// A scene that is built in.
pub struct StockScene {
    /// What users call it.
    pub name: &'static str,
    /// One sentence on what it shows.
    pub about: &'static str,
    /// Makes it.
    pub build: fn() -> Result<Scene, ImportError>,
}

/// All built-in scenes, in the order people see them.
pub static TABLE: &[StockScene] = &[
    StockScene {
        name: "courtyard",
        about: "a fountain between arcades at dusk, three coloured lights, two walkers, a swinging lantern",
        build: courtyard::build,
    },
    StockScene {
        name: "cubes",
        about: "four cubes turn over a chequered floor and throw their shadows on a sphere (Beam 2004)",
        build: cubes::build,
    },
    StockScene {
        name: "teapots",
        about: "Newell's teapots and balls under a hanging cut-out, whose letters fall on flat and curved alike (Kilgard 1999, figure 9)",
        build: teapots::build,
    },
    StockScene {
        name: "grid",
        about: "a light wanders through a grid of cubes in an amphitheatre (McGuire et al. 2003, image 5)",
        build: grid::build,
    },
    StockScene {
        name: "eye-in-shadow",
        about: "the camera stands in the shadow of a great disc and looks to the light: plain z-pass fails here",
        build: eye_in_shadow::build,
    },
    StockScene {
        name: "projector",
        about: "a slide projector throws a rose window past a turning sculpture; a globe of a lamp throws soft shadows (Kilgard 1999, figure 15)",
        build: projector::build,
    },
    StockScene {
        name: "cathedral",
        about: "a Gothic nave: three pilgrims, a swinging crown of light, a red and a green lamp in the aisles (McGuire et al. 2003, images 1 to 7)",
        build: cathedral::build,
    },
    StockScene {
        name: "stairs",
        about: "a beacon on top of 264 steps: at their foot 256 shadow volumes lie one in another, and eight bits count to none (McGuire et al. 2003, image 3)",
        build: stairs::build,
    },
    StockScene {
        name: "shadowfun",
        about: "toys tumble before a wall, and a warm and a cool lamp throw each of them on it twice (Kilgard 1999, figure 11)",
        build: shadowfun::build,
    },
    StockScene {
        name: "hello2rts",
        about: "solid letters over letters and balls, two lights: hello to real-time shadows (Kilgard 1999, figure 12)",
        build: hello2rts::build,
    },
    StockScene {
        name: "gallery",
        about: "an art room: two great mirrors face each other over a polished floor, a round one hangs between paintings; three coloured lights, sculptures, a visitor",
        build: gallery::build,
    },
    StockScene {
        name: "barbershop",
        about: "mirrors on both long walls show each other, the chairs and the barber without end (Kilgard 1999, figure 4)",
        build: barbershop::build,
    },
    StockScene {
        name: "corridor",
        about: "a hallway round two corners, a mirror at 45 degrees in each: a periscope to peer down it unseen (Kilgard 1999, section 3)",
        build: corridor::build,
    },
    StockScene {
        name: "terraces",
        about: "a marble floor on two levels: each tier has a reflection of its own (Kilgard 1999, section 3)",
        build: terraces::build,
    },
    StockScene {
        name: "figure3",
        about: "a dinosaur on a small shining table: without a stencil its reflection sticks out beyond the edge (Kilgard 1999, figure 3)",
        build: figure3::build,
    },
    StockScene {
        name: "kaleidoscope",
        about: "the eye inside a triangle of three mirrors, bright toys turning at its end",
        build: kaleidoscope::build,
    },
    StockScene {
        name: "portals",
        about: "doorways that lead elsewhere: out of a study to a terrace by night, and across it into itself without end",
        build: portals::build,
    },
    StockScene {
        name: "halo",
        about: "a hooded figure, a ring and an orb in magic haloes, over a polished floor with shadows (Kilgard 1999, figure 17)",
        build: halo::build,
    },
    StockScene {
        name: "csg",
        about: "a ball and a knot put together to one solid: either, both, one without the other (Kilgard 1999, figure 19)",
        build: csg::build,
    },
    StockScene {
        name: "figure7",
        about: "a dinosaur on a tile in mid-air, a board behind it, a sun and a lamp: two receivers of planar shadows (Kilgard 1999, figures 6, 7 and 14)",
        build: figure7::build,
    },
    StockScene {
        name: "runway",
        about: "a runway's markings and an aeroplane's shadow, all in the plane of the ground (Kilgard 1999, figure 18)",
        build: runway::build,
    },
];

/// Scenes made for one failure of the gallery each ([`crate::failures`]), or for the papers' diagrams
/// ([`crate::techniques::diagram`]): opened by name like the others, but listed there.
pub static DEMONSTRATIONS: &[StockScene] = &[
    StockScene {
        name: "hut",
        about: "a lamp in a hut with an open door: to the light there are walls all round",
        build: demonstrations::hut,
    },
    StockScene {
        name: "awning",
        about: "an awning of strips, long panels beside short ones: the seams are where T-junctions would be",
        build: demonstrations::awning,
    },
    StockScene {
        name: "slice",
        about: "a slab hangs before a lamp, a ball lies partly in its shadow: made to be cut open (show rays)",
        build: slices::slice,
    },
    StockScene {
        name: "slabs",
        about: "three slabs before a lamp, whose shadow volumes overlap: made to be cut open (show rays)",
        build: slices::slabs,
    },
];

/// The built-in scene of that name, from either table.
#[must_use]
pub fn find(name: &str) -> Option<&'static StockScene> {
    TABLE.iter().chain(DEMONSTRATIONS).find(|scene| scene.name == name)
}

/// Builds the built-in scene of that name.
#[must_use]
pub fn build(name: &str) -> Option<Result<Scene, ImportError>> {
    find(name).map(|scene| (scene.build)())
}
