//! What every pixel must be, by exact rays: the proof that the stencil is held against.
//!
//! A [`World`] is a scene at one point in time as triangles of world space, in double precision. From
//! a camera it casts rays through every pixel, and from what they meet to a light:
//!
//! ```text
//!        eye  --------- centre and four points 1/4 pixel around it ------> surface
//!                                                                             |
//!      light  <-- from each of the five; and to where the light stands <------+
//!                 when it is moved by a millionth of the scene's size
//! ```
//!
//! Only where all of them agree the pixel is *decided*: a picture that says otherwise there is wrong,
//! and one wrong pixel is too many. Where they do not, an outline or the border of a shadow passes
//! through the pixel: an [edge](Verdict::Edge), about which rounding may decide, counted but not asked
//! about. An outline may run within one object too, where one part of it stands before another: there the planes
//! of what two rays meet do not meet between the rays, as they do where the parts join.
//!
//! Moved is either end of the ray to the light, by a millionth of the scene's size: the light's, and the
//! surface's, where the eye would see it were it that much nearer, farther, or beside. Beside, it must
//! still begin on the same triangle: a rasteriser moves corners to the nearest 256th of a pixel, and may
//! give what lies on the joint of two triangles to the one and the edge of a volume that begins there to
//! the other.
//!
//! ```no_run
//! # use obscura::{frame::Camera, scene::{Pose, Scene}, truth::World};
//! # fn held(scene: &Scene, pose: &Pose, camera: &Camera, picture: &image::RgbaImage) -> bool {
//! let world = World::new(scene, pose); // once for each pose: views and lights may change
//! let verdicts = world.judge(camera, &pose.lights[0], [320, 180]);
//! verdicts.compare(picture).wrong() == 0 // `picture` as `show shadow` draws it
//! # }
//! ```
//!
//! # What is a surface, and what casts
//!
//! Surfaces are what the depth buffer gets: triangles beyond the near plane, from the front only
//! unless their material is double-sided; of alpha-masked materials what their texture leaves, and
//! near the cutoff nobody knows; blended materials are none.
//!
//! Casters are the triangles of a mesh's [topology](crate::geometry::topology), whole, masked or
//! not. Of its solid components those count that face the light: a ray from inside a solid towards
//! the light leaves it through one. Of the soup every one counts. So a light inside a solid shines
//! out of it and one inside soup is shut in: that is what shadow volumes are asked to do here, and
//! exactly that is verified. The ray starts a hair before the surface, on the side that is seen: the
//! dark side of a sheet is in the sheet's own shadow.
//!
//! Spot lights are points with a range here, for `show shadow` does not know their cones.
//!
//! # Planar shadows
//!
//! They are claimed to be right on their receivers, and nowhere else: of other surfaces there is no verdict
//! ([`World::of_receivers`]). What casts is the same, so a receiver is asked about all the scene's casters, its own mesh
//! among them.
//!
//! # Mirrors
//!
//! A ray that meets a mirror on its reflecting side goes on, as often as the settings let it; past that the
//! mirror is a surface as any other. As the renderer does, and K section 3 before it, the eye is reflected and
//! not the world:
//!
//! ```text
//!        eye  .               _ surface  ----> light
//!                ` .     _ -
//!     ------======== m ========------    the mirror's plane
//!               _ -
//!          _ -
//!     reflected eye
//! ```
//!
//! From the reflected eye the ray is straight, its distances are still depths, and what it meets is met where
//! it really is, so that the way to the light is asked there; through more mirrors the reflected eye is
//! reflected again. Seen is only what lies over the plane, by more than what rounding may make of it: a hit no
//! more than a hair over it is an edge, and triangles with no corner higher than the renderer cuts are out of
//! sight, a frame's back for example. The places of a pixel must agree on every mirror of the way. Mirrors cast
//! shadows as other surfaces do.
//!
//! Light off a mirror ([`crate::scene::off_mirror`]) is judged as the light it comes from would be: the way from the
//! reflected light to the surface must lead through one of the mirror's triangles and meet no caster after it, and the
//! way from the light itself to the surface's reflection must meet none before it. What is met less than a hair off the
//! mirror's plane is an edge.
//!
//! Besides the verdicts [`World::trace`] tells which instance each pixel shows through which mirrors, to hold a
//! picture of exactly that against ([`Surfaces`]). Where surfaces of two instances lie closer together than
//! steps of the depth buffer, that is an edge, and the verdict is not.
//!
//! # Solids put together
//!
//! Where a scene has two solids put together ([`crate::scene::Solid`]), neither is a surface by itself. Of every ray the
//! intervals are taken that it spends in each of them, from infinity on, and where it enters the result it meets a
//! surface; the way to a light is barred where it leaves it. The mesh that casts the solid's shadow has no say.
//!
//! # Fast enough
//!
//! Nine rays to the surface and fifteen to each light would be much for every pixel. But they run close
//! together: the tree over the triangles is descended once for all of them, along the middle one with boxes grown by
//! their distance from it, and only at the triangles are they told apart.

mod compare;
mod eye;
mod judge;
mod mask;
mod path;
mod solid;
mod tree;
mod world;

pub use compare::{Comparison, Verdict, Verdicts, Wrong, WrongPixel, paint};
pub use judge::Traced;
pub use path::{Sighting, SurfaceComparison, Surfaces, WrongSurface};
pub use world::World;
