//! What can be left out of a light's count, and McGuire's three cases (M section 6 and figure 4).
//!
//! A volume is left out as a whole where it can hold no surface that is lit and in view:
//!
//! - its caster lies beyond the light's range, or outside its cone (M's first conditional: rays only
//!   lead away from the light, so what a caster out there shades lies out there too);
//! - the volume's bounds, the hull of the caster's box and of the box thrown away from the light,
//!   miss the view: the frustum behind the light's scissor (M's `viewFrustum`, line 7);
//! - or they meet the view, but no surface in it.
//!
//! Then each visible surface lies outside the volume, its count is zero by every exact technique, and
//! so is what the eye's count would add and the sides would take away again. Leaving *parts* of a
//! volume out is another matter: z-fail counts faces behind the surface, on screen, so a cap that is
//! nowhere on screen counts nothing, and each cap may go by its own bounds (M's `DrawLightCap` and
//! `DrawDarkCap`). The sides' bounds are the volume's.
//!
//! The cases ask whether the near rectangle can be in the caster's shadow: whether its box reaches into
//! the *occlusion pyramid* between the light and the near rectangle (L; M figure 2). Ours holds the eye
//! as well, so that the answer is right also where nothing is clipped at the near plane.
//!
//! ```text
//!   case 1   the pyramid is clear: counting may start at the near plane, sides are enough
//!   case 2   it may not be, but the light cap is out of view: z-fail with sides and dark cap
//!   case 3   it may not be, and the light cap is in view: z-fail with both caps
//! ```
//!
//! M calls them so for a bound by boxes, and so do we: case 2 and 3 say *may be*, not *is*.

use std::cell::OnceCell;

use arrayvec::ArrayVec;
use glam::{DMat4, DVec3, DVec4};

use crate::frame::Reason;
use crate::frame::plan::{Case, View};
use crate::geometry::clamping::{self, Piece, Pyramid};
use crate::geometry::footprint::{Receiver, Shaft};
use crate::geometry::frustum::{cube, hull_rect, screen_rect};
use crate::geometry::pixels::{Grid, common};
use crate::geometry::{Aabb, Body, VolumeParts};
use crate::scene::{AlphaMode, LightKind, Pose, PosedLight, Scene};
use crate::settings::{Culling, LightBounds, Show};
use crate::techniques::windows::Footprint;
use crate::techniques::workspace::{Lent, Workspace};

/// Where things are in one view, asked once a frame.
#[derive(Debug)]
pub struct Stalls<'w> {
    /// Each instance's box.
    pub boxes: Lent<'w, Body>,
    /// Whether any of an instance's opaque surfaces may be in view.
    seen: Lent<'w, bool>,
    /// Instances, the largest first: they are the likeliest to receive a shadow.
    by_size: Lent<'w, usize>,
    /// All that is seen, for views by way of a mirror: what lies in its window, for ever.
    window: Option<Body>,
}

impl<'w> Stalls<'w> {
    /// The boxes of `scene` as posed, and which of them `view` may see, by way of a mirror through its `window`.
    #[must_use]
    pub fn new((scene, pose): (&Scene, &Pose), view: &View, window: Option<Body>, workspace: &'w Workspace) -> Self {
        let frustum = Body::frustum(view.camera.eye, view.camera.near_rectangle());
        let Workspace { sizes, boxes, flags, numbers, .. } = workspace;
        let (mut sizes, mut boxes, mut seen) = (sizes.lend(), boxes.lend(), flags.lend());
        for (node, _, mesh) in scene.instances() {
            let bounds = pose.bounds(scene, node);
            let body = Body::boxed(&bounds, &pose.world_from_object[node]);
            let receives = mesh.primitives.iter().any(|part| scene.materials[part.material].alpha != AlphaMode::Blend);
            let in_window = window.as_ref().is_none_or(|window| window.may_meet(&body));
            seen.push(receives && frustum.may_meet(&body) && in_window);
            sizes.push(Some(bounds.transformed(&pose.world_from_object[node]).radius()));
            boxes.push(body);
        }
        let mut by_size = numbers.collect(0..boxes.len());
        let size = |instance: usize| sizes[instance].unwrap_or(0.0);
        by_size.sort_unstable_by(|a, b| size(*b).total_cmp(&size(*a)).then(a.cmp(b)));
        Self { boxes, seen, by_size, window }
    }

    /// Whether a body may be in the window of a view by way of a mirror.
    pub(crate) fn in_window(&self, body: &Body) -> bool {
        self.window.as_ref().is_none_or(|window| window.may_meet(body))
    }
}

/// Which surfaces a show asks about: the others' counts are nobody's business.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Interest {
    /// All in view.
    InView,
    /// Those within the light's range.
    InRange,
    /// Those the light shines on: within its range and its cone.
    Lit,
}

impl From<Show> for Interest {
    fn from(show: Show) -> Self {
        match show {
            Show::Stencil | Show::Overflow => Self::InView,
            Show::Shadow => Self::InRange,
            _ => Self::Lit,
        }
    }
}

/// The pixels a light can reach, by bounds that were clipped and projected; `None` where it reaches none.
#[must_use]
pub fn light_rect(
    light: &PosedLight,
    bounds: LightBounds,
    interest: Interest,
    clip_from_world: &DMat4,
    size: [u32; 2],
) -> Option<[u32; 4]> {
    let whole = [0, 0, size[0], size[1]];
    // The count itself has no bounds.
    let bounds = if interest == Interest::InView { LightBounds::None } else { bounds };
    let (at, range) = (light.position, light.range);
    let by_box = || hull_rect(cube(at, range), clip_from_world, size);
    let by_ball = || screen_rect(at, range, clip_from_world, size);
    let by_cone = || match light.kind {
        // What lies outside the cone is not lit, but has a verdict.
        LightKind::Spot { outer, .. } if interest == Interest::Lit => {
            let cone = Body::cone_within(at, light.direction, outer.into(), range);
            cone.map_or(Some(whole), |cone| hull_rect(cone.hull(), clip_from_world, size))
        }
        _ => Some(whole),
    };
    let mut rect = whole;
    if bounds.has_ball() && range.is_finite() {
        rect = common(rect, by_ball()?)?;
    }
    if bounds.has_box() && range.is_finite() {
        rect = common(rect, by_box()?)?;
    }
    if bounds.has_cone() {
        rect = common(rect, by_cone()?)?;
    }
    Some(rect)
}

/// What one light's shadows could matter to.
#[derive(Debug)]
pub struct Audience<'a> {
    light: &'a PosedLight,
    stalls: &'a Stalls<'a>,
    interest: Interest,
    culling: Culling,
    scissor: [u32; 4],
    clip_from_world: DMat4,
    size: [u32; 2],
    /// The view behind the light's scissor.
    view: Body,
    /// Its directions, for what lies at infinity.
    sky: Body,
    /// Between the light, the near rectangle and the eye.
    occlusion: Body,
    cone: Option<Body>,
    /// Instances that are in view and that the light reaches, the largest first.
    receivers: Lent<'a, usize>,
    /// Of each instance, whether it is one of them.
    receives: Lent<'a, bool>,
    /// The same, as shadows fall on them.
    grounds: Lent<'a, Receiver>,
    grid: Grid,
    eye: DVec3,
    /// Metres that a clamped volume's planes stay away from what receives its shadow.
    margin: f64,
}

/// One caster's volume before its audience.
#[derive(Debug, Clone, PartialEq)]
pub struct Sight {
    /// Why it need not be counted at all.
    pub dropped: Option<Reason>,
    /// M's case; none for volumes that need not be counted.
    pub case: Option<Case>,
    /// The parts that may be on screen.
    pub parts: VolumeParts,
    /// The pixels where it may hold a surface that matters.
    pub rect: [u32; 4],
    /// The cells of the picture ([`Grid`]), likewise.
    pub cells: u64,
    /// The pieces it may be clamped to; none where all of it is counted.
    pub pieces: Pieces,
}

/// The pieces of a clamped volume, nearest the light first.
pub type Pieces = ArrayVec<Piece, { clamping::MOST }>;

impl Sight {
    /// Nothing is drawn of it, though it was not dropped.
    pub const NOTHING: Self =
        Self { dropped: None, case: None, parts: VolumeParts::NONE, rect: [0; 4], cells: 0, pieces: Pieces::new_const() };
}

/// Of the size of what receives shadows: far above the rounding of what is thrown onto a plane.
const MARGIN: f64 = 3e-4;

impl<'a> Audience<'a> {
    /// What `light`, whose pixels are `scissor`, can matter to in `view`, a picture of `size`. Where
    /// `culling` is off nothing in view is left out.
    #[must_use]
    pub fn new(
        light: &'a PosedLight,
        (stalls, workspace): (&'a Stalls<'a>, &'a Workspace),
        view: &View,
        interest: Interest,
        culling: &Culling,
        scissor: [u32; 4],
        size: [u32; 2],
    ) -> Self {
        let camera = &view.camera;
        let frustum = Body::frustum(camera.eye, camera.near_rectangle_of(scissor, size));
        let cone = match light.kind {
            LightKind::Spot { outer, .. } if interest == Interest::Lit => {
                Body::cone(light.position, light.direction, outer.into())
            }
            _ => None,
        };
        let limits = interest != Interest::InView && light.range.is_finite();
        let ball = limits.then(|| ball_of(light));
        let behind_scissor = scissor != [0, 0, size[0], size[1]];
        let reached = |instance: &usize| {
            let body = &stalls.boxes[*instance];
            stalls.seen[*instance]
                && (!behind_scissor || frustum.may_meet(body))
                && ball.as_ref().is_none_or(|ball| ball.may_meet(body))
                && cone.as_ref().is_none_or(|cone| cone.may_meet(body))
        };
        let receivers = workspace.numbers.collect(stalls.by_size.iter().copied().filter(reached));
        let mut receives = workspace.flags.collect(stalls.boxes.iter().map(|_| false));
        receivers.iter().for_each(|receiver| receives[*receiver] = true);
        let clip_from_world = camera.clip_from_world();
        let ground = |instance: &usize| Receiver::new(&stalls.boxes[*instance], &clip_from_world, size);
        let asked = culling.on && (culling.footprints || culling.clamping);
        let grounds = workspace.grounds.collect(receivers.iter().filter(|_| asked).filter_map(ground));
        let bounds = grounds.iter().fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[min, max], ground| {
            [min.min(ground.bounds[0]), max.max(ground.bounds[1])]
        });
        let largest = (bounds[1] - bounds[0]).max_element().max(0.0);
        Self {
            light,
            stalls,
            interest,
            culling: *culling,
            scissor,
            grid: Grid::new(size),
            eye: camera.eye,
            margin: MARGIN * largest,
            grounds,
            clip_from_world,
            size,
            sky: frustum.directions_of(),
            view: frustum,
            occlusion: Body::occlusion(light.into(), camera.near_rectangle(), camera.eye),
            cone,
            receivers,
            receives,
        }
    }

    /// The part of `receivers`, a box that holds every surface, that the light reaches, and the eye: its
    /// volumes need not go farther.
    #[must_use]
    pub fn receivers_within(&self, receivers: &Aabb, eye: DVec3) -> Aabb {
        if self.interest == Interest::InView || !self.light.range.is_finite() {
            return *receivers;
        }
        let (at, range) = (self.light.position, DVec3::splat(self.light.range));
        let ball = Aabb::around(at - range, at + range);
        let both = Aabb { min: receivers.min.max(ball.min), max: receivers.max.min(ball.max) };
        if both.is_empty() { *receivers } else { both.union(&Aabb::around(eye, eye)) }
    }

    /// What of a caster's volume matters: its box `body` has the world-space `corners` (as [`Aabb::corners`] orders
    /// them), and the volume ends on `end`. `instance` is the caster's, where it stands there itself and is not reflected;
    /// it has so many `triangles`.
    #[must_use]
    pub fn sight(
        &self,
        (instance, body): (Option<usize>, &Body),
        corners: &[DVec3; 8],
        triangles: usize,
        in_range: bool,
        end: Option<DVec4>,
    ) -> Sight {
        let dropped = |reason| Sight { dropped: Some(reason), rect: self.scissor, ..Sight::NOTHING };
        if !in_range {
            return dropped(Reason::OutOfRange);
        }
        let near_clear = !self.occlusion.may_meet(body);
        let in_view = self.view.may_meet(body) && self.stalls.in_window(body);
        let case = match (near_clear, in_view) {
            (true, _) => Case::One,
            (false, false) => Case::Two,
            (false, true) => Case::Three,
        };
        if !self.culling.on {
            let all = (VolumeParts::ALL, self.scissor, Grid::ALL);
            return Sight { case: Some(case), parts: all.0, rect: all.1, cells: all.2, ..Sight::NOTHING };
        }
        if self.cone.as_ref().is_some_and(|cone| !cone.may_meet(body)) {
            return dropped(Reason::OutOfCone);
        }
        let light = DVec4::from(self.light);
        let sooner = self.sooner(corners, end);
        // Of what is in view and receives light nothing more is asked: it shades itself.
        let volume = OnceCell::new();
        let volume = || volume.get_or_init(|| Body::volume(corners, light, sooner));
        if !(in_view || self.view.may_meet(volume()) && self.stalls.in_window(volume())) {
            return dropped(Reason::OutOfView);
        }
        let shades_itself = instance.is_some_and(|instance| self.receives[instance]);
        if !(shades_itself || self.receivers.iter().any(|receiver| self.stalls.boxes[*receiver].may_meet(volume()))) {
            return dropped(Reason::ReachesNothing);
        }
        // All that is drawn of it, not only what matters: its parts go into steps whose scissors differ,
        // and a side that is drawn where its cap is cut off would count by itself.
        let drawn = Body::volume_hull(corners, light, end);
        let Some(rect) = hull_rect(drawn.hull(), &self.clip_from_world, self.size).and_then(|rect| common(rect, self.scissor))
        else {
            return dropped(Reason::OutOfView);
        };
        let dark_cap = light.w != 0.0 && {
            let cap = Body::dark_cap(corners, self.light.position, end);
            if end.is_some() { &self.view } else { &self.sky }.may_meet(&cap)
        };
        let parts = VolumeParts { light_cap: in_view, dark_cap, ..VolumeParts::SIDES };
        let mut pieces = Pieces::new();
        if let Some(end) = end.filter(|_| self.culling.clamping) {
            let Some(found) = self.pieces((corners, triangles), shades_itself, end) else {
                return dropped(Reason::ReachesNothing);
            };
            pieces = found;
        }
        let cells = if pieces.is_empty() { self.footprint(corners, sooner, rect) } else { self.grid.reached_by(rect) };
        Sight { dropped: None, case: Some(case), parts, rect, cells, pieces }
    }

    /// The pieces that a volume may be clamped to, empty where it is not worth it; `None` where it holds nothing.
    fn pieces(&self, (corners, triangles): (&[DVec3; 8], usize), shades_itself: bool, end: DVec4) -> Option<Pieces> {
        let Some(mut pyramid) = Pyramid::new(corners, self.light.position, end, self.margin) else { return Some(Pieces::new()) };
        if shades_itself {
            let own = hull_rect(corners.iter().map(|corner| corner.extend(1.0)), &self.clip_from_world, self.size);
            pyramid.shades_itself(own.unwrap_or(self.scissor));
        }
        self.grounds.iter().for_each(|ground| pyramid.falls_on(ground.bounds, ground.rect));
        let triangles = Footprint::of(0, [0; 4], triangles).triangles;
        let mut pieces = pyramid.pieces(&self.clip_from_world, self.size, self.eye, triangles);
        for piece in &mut pieces {
            // Beyond the light's own pixels nothing is counted.
            piece.drawn = common(piece.drawn, self.scissor).unwrap_or([0; 4]);
            piece.matters = common(piece.matters, self.scissor).unwrap_or([0; 4]);
        }
        pieces.retain(|piece| piece.matters[2] > 0);
        let whole = |piece: &Piece| piece.start.is_none() && !piece.closed;
        match pieces.as_slice() {
            [] => None,
            [one] if whole(one) => Some(Pieces::new()),
            _ => Some(pieces),
        }
    }

    /// The cells of the picture where a volume that is drawn within `rect` may hold a surface.
    fn footprint(&self, corners: &[DVec3; 8], end: Option<DVec4>, rect: [u32; 4]) -> u64 {
        if !self.culling.footprints {
            return Grid::ALL;
        }
        let Some(shaft) = Shaft::new(corners, self.light.into(), end, &self.clip_from_world) else { return Grid::ALL };
        let most = self.grid.reached_by(rect);
        let mut cells = 0;
        for ground in &*self.grounds {
            // Of most pairs a glance at their rectangles says that nothing new is to be had.
            let Some(both) = common(ground.rect, rect) else { continue };
            if self.grid.reached_by(both) & !cells == 0 {
                continue;
            }
            if let Some(fallen) = shaft.falls_on(ground, self.size) {
                cells |= self.grid.reached_by(fallen);
            }
        }
        cells & most
    }

    /// Where the volume stops to matter: at its end, or at the light's.
    fn sooner(&self, corners: &[DVec3; 8], end: Option<DVec4>) -> Option<DVec4> {
        /// Rays nearly along a plane meet it very far away.
        const LEAST_SLOPE: f64 = 0.02;
        if self.interest == Interest::InView || !self.light.range.is_finite() {
            return end;
        }
        let (at, range) = (self.light.position, self.light.range);
        let middle = (corners[0] + corners[7]) / 2.0 - at;
        let Some(ahead) = middle.try_normalize() else { return end };
        // No point of the light's ball lies beyond the plane that touches it in this direction.
        let reach = range.max(corners.iter().map(|corner| ahead.dot(*corner - at)).fold(0.0, f64::max));
        let towards = |corner: &DVec3| ahead.dot(*corner - at) > LEAST_SLOPE * corner.distance(at);
        if !corners.iter().all(towards) {
            return end;
        }
        let along = |plane: DVec4| -(plane.truncate().dot(at) + plane.w) / plane.truncate().dot(middle);
        let touching = ahead.extend(-ahead.dot(at) - reach);
        Some(end.filter(|end| along(*end) <= along(touching)).unwrap_or(touching))
    }
}

/// The box about a light's range.
fn ball_of(light: &PosedLight) -> Body {
    let (at, range) = (light.position, DVec3::splat(light.range));
    Body::boxed(&Aabb::around(at - range, at + range), &glam::DAffine3::IDENTITY)
}
