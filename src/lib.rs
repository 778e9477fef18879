//! Obscura, a laboratory for the stencil buffer. This page is its architecture: how the house is
//! built, and why.
//!
//! # The way of the data
//!
//! ```text
//!   command line, panel -> Settings -+
//!                                    +-> director::stage: pose, camera, plan, validate
//!   scene::open -------> Scene ------+              |
//!                                               FramePlan (data)
//!                                                   |
//!                                             gpu::Renderer
//!                                             /           \
//!                                  the window's frame    a picture read back
//! ```
//!
//! The window and the headless commands share everything but the last arrow. Nothing flows back up.
//!
//! - [`settings::Settings`] is all that a user can choose, as plain data. The command line fills it, the
//!   panel edits it, tests build it; [`cli::render_command`] turns it back into the command line that
//!   draws the same picture.
//! - [`scene::Scene`] is what a file or a stock scene holds: nodes, meshes with their edge topology,
//!   materials, lights, cameras, animations. Nothing changes it; [`scene::Pose`] is all of it that depends
//!   on time.
//! - [`frame::FramePlan`] is the heart: a list of [`frame::Step`]s, each with a sentence on what it is for
//!   and its *whole* depth, stencil, blend and cull state, in ids and values only. So a frame can be
//!   printed, compared with a stored text, checked and explained in the panel without a GPU.
//! - [`director::plan`] is the only place where the order of passes is written, and reads aloud as the frame. Frame after
//!   frame is planned in the same memory ([`director::Planner`], [`techniques::workspace`]): it is memory, not state.
//! - [`frame::validate::validate`] refuses a plan that tests bits nobody set, writes bits that are not its
//!   own, or counts a volume inside out.
//! - [`failures::spoil`] makes a classic mistake in a finished plan where the settings ask for one: a pure
//!   change of data, which names the rule it breaks.
//! - [`gpu`] carries plans out and decides nothing. The state in a step is its pipeline's cache key.
//!
//! # The rooms
//!
//! | room | what is in it |
//! | --- | --- |
//! | [`geometry`] | pure mathematics: bounds, the near pyramid, topology, silhouettes, volumes, the eye's count, mirrors and views in them, planar shadows |
//! | [`scene`] | the scene and its pose, glTF import, the mesh doctor, the stock scenes |
//! | [`frame`] | the plan's types: steps, named states, the stencil's bits, camera, validation |
//! | [`techniques`] | one file each and a table of them: how a caster's volume is counted, and why |
//! | [`director`] | the pass order |
//! | [`failures`] | the classic mistakes: what each looks like, why, and how it spoils a finished plan |
//! | [`gpu`] | the device, shaders, pipelines, buffers, encoding, read-back, timing |
//! | [`figures`] | the papers' figures: what is to be seen in each, and the settings that draw it |
//! | [`truth`] | exact rays: what each pixel must be, and the comparison with what was drawn |
//! | [`headless`] | pictures, the tour, lists, reports and measurements without a window |
//! | [`app`] | the window: loop, surface, input, and the panel, which edits settings and nothing else |
//!
//! Imports go downward: `app` and `headless` to `director`, to `failures` and `techniques`, to `frame`, to `scene`, to
//! `geometry`; `gpu` reads `frame` and `scene`; `truth` reads `scene`, `geometry` and the camera. Settings and scene name each other's choices (which
//! scene; which animation), and everybody may read settings.
//!
//! # One frame
//!
//! Ambient light lays depth. Then light by light: the stencil starts at how many volumes hold the eye (0
//! unless counting starts there), the volumes are counted, and the light is added where the count is zero.
//! Blended surfaces, halos ([`techniques::halo`]), overlays and the tone curve come last.
//!
//! A frame of one light at most, with nothing blended, goes a shorter way: the same count, but surfaces are
//! drawn in their final colour straight into the picture: those that may be in shadow as if they were lit, to lay depth, and
//! again where the count says so. Or, where triangles are many or lights two to four, surfaces are
//! drawn once in all, what light needs to know of them is kept, and one step shades every pixel in the lights that left
//! their bits after they were counted ([`techniques::deferred`]). A light with a size stands in the pose as several
//! points, each counted as a light of its own ([`scene::area`]); and a picture may be the mean of many frames,
//! each with other points ([`frame::Gather`]).
//!
//! # Mirrors
//!
//! A frame with mirrors is a tree of views ([`frame::View`]): the eye's, and for each mirror that shows in a view the
//! view through it, planned from the mirror's polygons clipped against what that view sees ([`geometry::sight`]).
//!
//! ```text
//!   view:   ambient light, depth
//!           for each mirror that shows:  tag its pixels    its level, where depth is the mirror's
//!                                        cover them        depth to infinity, background
//!                                        view ...          the same again, seen by the reflected eye
//!                                        uncover them      depth and tag as they were, the reflection dimmed
//!           light by light:              count, add        the mirrors' own look too
//! ```
//!
//! Not the world is reflected but the eye ([`frame::Camera::reflected`]), so positions, volumes and lights stay what they
//! are, and only windings change their sense. A step of a view asks for its level in the mirror bits; one
//! `Invert` of the bits in which two levels differ leads from each to the other. Where exact values are shown the order is another: a view's
//! count comes first, and its mirrors' views then take their pixels over.
//!
//! A portal is a mirror with another turn of the eye: a rigid transform to behind its other doorway
//! ([`frame::Window::turn`](frame::plan::Window::turn)), where what is seen begins.
//!
//! What lies behind a mirror's plane is left out fragment by fragment, not by clip distances: a triangle that is cut has
//! other depths in its last bits than the light cap on it, which nothing cuts. Volumes are never cut; a caster that is not
//! wholly before the plane is counted by compared z-fail ([`techniques::Caster::surface_covers`]). Batches end in a step
//! that asks for a count which is *not* zero, and cannot ask for a view as well: in a view's own pixels it is right, and
//! other views count anew; where a view's count must stay it is counted wide.
//!
//! Light comes off mirrors too, once: a virtual light behind the mirror is a light of the pose as any other
//! ([`scene::off_mirror`]), and its count has a batch more, the beam of the mirror's outline
//! ([`techniques::off_mirror`]). Volumes may be thrown from a part of a caster, and from its reflection
//! ([`frame::Piece`]). Where a triangle was cut its light cap differs from the drawn surface in last bits; such caps are
//! pushed back a hair ([`frame::Method::ZFailCut`]).
//! # Planar shadows
//!
//! Where shadows are planar ([`settings::PlanarMode`]) nothing is counted: a caster's light cap is thrown onto the plane of a
//! receiver by one matrix ([`geometry::planar_shadow`]), and so are planned with the volumes, whose machinery draws them.
//! Depth has no say in where they fall. A receiver's visible pixels hold a value of their own in the stencil, and every
//! shadow asks for it and takes it away, or moves it on: so it leaves no receiver, and no pixel is met twice. What makes
//! a point beyond the light no shadow is the clip volume itself; what lies behind a receiver is cut on the CPU, in double
//! precision. `director/planar.rs` has the order of each mode, for the eye's view and those in mirrors alike.
//!
//! `--show cases`, `bounds`, `overflow` and the rest read what the plan decided; none decides by itself. Diagrams
//! ([`techniques::diagram`]) are worked out in double precision on the plane that the eye looks in: as many convex
//! polygons hold a place there as volumes do.
//!
//! # Spaces and depth
//!
//! Right-handed, +Y up, metres, radians, linear colour. A matrix is `target_from_source`, a point's name
//! says its space. Positions of meshes are single precision in object space; nodes, lights and cameras
//! are double precision, and only `clip_from_object` is rounded, at the end.
//!
//! Depth is reverse-Z with an infinite far plane: the near plane maps to 1, infinity to 0, and nearer is
//! `Greater`. What a light throws to infinity (w = 0) lands on depth 0 exactly, so volumes need no epsilon
//! and no far plane. Surfaces and volumes get their clip position from one WGSL function, marked
//! `@invariant`: the same place has the same depth to the last bit.
//!
//! # Solids
//!
//! Two solids put together are drawn before a view's other surfaces, as depth alone ([`techniques::csg`]): each layer of
//! either is looked at in a target of its own, with a stencil of its own ([`frame::stencil`]), and what is the result's
//! is merged into the scene's depth. Their surfaces then find themselves by that depth, and need not know of it. What
//! casts the shadow is a mesh of the result: a scene is combined with it before it is planned ([`scene::solid`]).
//!
//! # The stencil's bits
//!
//! ```text
//!   bit   7 6 5 4 3 2 1 0
//!         [  shadow count ]      modulo 256
//!         m m m [ count   ]      mirrors seen in mirrors: how deep, in as many bits as it takes; both
//!                                below are then counted in what is left
//!         V [shadow count ]      counting in batches: V, shadowed by a batch before; modulo 128
//!         B [shadow count ]      within depth bounds: B, beyond the light's bounds, nothing is counted
//!         d c b a [ count ]      points of a light with a size, each with a bit of its own
//!                   T g g        when all light is there: T, an object with a halo; g, the pixel glows
//!         r r r r r r r s        receivers of planar shadows: which one; shadowed, or lit already
//!         r r V [ count ]        the same beside volumes: V, shadowed by what is projected
//! ```
//!
//! A picture that dissolves into another is two frames in one plan, one after the other; the first is kept in a texture,
//! a pattern marks the stencil, and the first is laid again where nothing is marked (`director::dissolve`). A frame of
//! another scene ([`scene::Scene::partner`]) is a plan by itself ([`frame::FramePlan::then`]), drawn into the same targets.
//!
//! Decals have one bit for as long as they are drawn, before the lights or after them ([`techniques::decals`]): it is free
//! again when their ground is unmarked. Depth complexity and the playground have a frame, and all eight bits, to
//! themselves: a clamped count knows no fields ([`techniques::complexity`]), and who plays may choose any mask
//! ([`techniques::playground`]).
//!
//! [`frame::stencil`] owns them; no other code writes a mask. Counting wraps, so the order of faces does
//! not matter, and a clear may set any starting value. A multiple of the field's size would be taken for
//! none: the plan bounds how many volumes can lie over one pixel ([`geometry::overlap`]), and where that
//! is too many it counts in batches, each collapsed into the verdict bit V, or in a float target
//! ([`techniques::wide`]), whose verdict is then written into the stencil.
//!
//! # Exactness
//!
//! A volume need not reach to infinity: where a plane lies behind every surface and the eye, it ends
//! there, and every visible count stays what it was ([`geometry::ending`] says why). The half-space rule
//! for the dark cap's fan asks all of the caster's vertices, not only the silhouette's: a light in a room
//! with a door sees a rim in one half-space and walls all round ([`geometry::volume`]).
//!
//! Nor need it be counted all over the picture: only in the cells where it may hold a surface
//! ([`geometry::footprint`]), joined into windows ([`techniques::windows`]). Elsewhere its fronts and backs cancel.
//! All parts of a volume are counted in the same windows, and windows do not overlap: a count is whole wherever it is.
//!
//! Nor all of its length: exact forms count the pieces of it that lie about what can receive its shadow, each capped
//! where it was cut ([`geometry::clamping`]). What lies between two planes it holds as often as the piece between them does.
//! Which pieces depends on scene, light and eye, not on the technique: techniques that cut keep pixels equal to one another.
//!
//! The shaders are specialised for what a step's materials and light have ([`frame::Look`]), because a
//! software GPU pays for every instruction of every pixel. For the same reason light is worked out at the
//! vertices where it changes in proportion, and the picture's format does not convert: the shaders encode
//! sRGB. No branch in a shader asks uniforms alone: lavapipe would work the shader out anew at every draw, and keep each copy. Small casters' volumes are drawn by one call a step (`gpu::merged`), instances of one mesh by one.
//!
//! Which triangles face the light is decided once; silhouette, caps and the eye's count read that one
//! decision, so a volume is closed whatever rounding does ([`geometry::silhouette`]). What the light sees
//! edge-on goes with its neighbour towards the light, so that no side covers it at its own depth. What was decided is
//! remembered while neither caster nor light moves ([`geometry::kept`]), and shared by the plan and the volumes. A compute
//! shader can decide in the CPU's place (`gpu::compute`): floats where they are clear, else the CPU's own arithmetic in whole
//! numbers, and indices in the CPU's order, so that plan, eye's count and volumes agree as before. Z-fail and
//! exact z-pass are two roads to one count, and a test holds them to the same stencil value in every pixel.
//!
//! What is left is the rasteriser's own grid. It moves corners by up to half of a 256th of a pixel, and on
//! lavapipe finds depths as if they were not moved: so close to an edge a steep triangle gets a depth from
//! beyond its edge. Where that edge is a silhouette's in a fold, the side that begins there then lies before the surface
//! instead of behind it, and the count is off by one. One pixel in some ten to thirty million is wrong by that. Moving the corners to the grid in the
//! vertex shader was tried: coverage and depth agree then, but facets tilt, and more is lost than won. Planar shadows ask
//! nothing of depth, but their outlines lie on the grid too, and may be moved past a pixel's centre: two pixels are
//! known where that is no edge, because the gap beyond is narrower than a pixel's places stand apart (`tests/planar_grid.rs`).
//!
//! A volume may be thrown from something else than its caster's silhouette: a planar cut-out, or the
//! silhouette flattened into one ([`frame::Cutout`]). The shape of a volume and the way it is counted
//! are independent; such volumes are thrown by a matrix and counted by z-fail.

pub mod app;
pub mod cli;
pub mod director;
pub mod failures;
pub mod figures;
pub mod frame;
pub mod geometry;
pub mod gpu;
pub mod headless;
pub mod scene;
pub mod settings;
pub mod techniques;
pub mod truth;
