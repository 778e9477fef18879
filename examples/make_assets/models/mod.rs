//! Every model file: its name and its bytes. Units are metres, +Y is up, models stand on y = 0.

mod architecture;
mod cathedral;
mod figure;
mod furniture;
mod glb;
mod math;
mod pilgrim;
mod polygon;
mod skeleton;
mod solids;
mod soup;
mod stained_glass;
mod stairs;
mod teapot;
mod texture;
mod toys;

/// Made anew each time, always the same.
pub fn all() -> Vec<(&'static str, Vec<u8>)> {
    vec![
        ("solids.glb", solids::file()),
        ("teapot.glb", teapot::file()),
        ("cutout.glb", solids::cutout()),
        ("floors.glb", architecture::floors()),
        ("architecture.glb", architecture::file()),
        ("furniture.glb", furniture::file()),
        ("walker.glb", figure::file()),
        ("toys.glb", toys::file()),
        ("stairs.glb", stairs::file()),
        ("pilgrim.glb", pilgrim::file()),
        ("cathedral.glb", cathedral::file()),
    ]
}
