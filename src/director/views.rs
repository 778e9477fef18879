//! The eye, the eyes reflected in mirrors, and what is known of one of them while its steps are planned.

use std::cell::OnceCell;

use super::Frame;
use crate::frame::plan::{View, Window};
use crate::frame::state::Winding;
use crate::geometry::frustum::NearPyramid;
use crate::geometry::planar::height;
use crate::geometry::sight::{Sight, worst_case};
use crate::geometry::{Aabb, Body};
use crate::scene::{Pose, Scene};
use crate::settings::{AreaMode, LEAST_TEXTURE, MOST_TEXTURE, MirrorLight, MirrorMode, Show};
use crate::techniques;
use crate::techniques::culling::Stalls;
use crate::techniques::mirrors::Mirrors;
use crate::techniques::off_mirror::more_ambient;
use crate::techniques::surfaces::Place;
use crate::techniques::workspace::{Lent, Workspace};

/// Views in one frame: mirrors that show each other may have more than anyone waits for.
const MOST_VIEWS: usize = 512;

/// Of the scene's radius: how high over a mirror's plane a reflection begins.
pub const SLACK: f64 = 1e-5;

/// One view, and what is asked of it again and again.
pub(super) struct Outlook<'w> {
    /// Its number among the plan's.
    pub view: usize,
    /// Between its eye and its near rectangle.
    pub near_pyramid: NearPyramid,
    /// Of each instance, whether it reaches into that pyramid, once asked.
    pub across: Lent<'w, OnceCell<bool>>,
    /// Where everything is.
    pub stalls: Stalls<'w>,
    /// Every surface, and the eye: volumes need not reach farther.
    pub receivers: Aabb,
    /// Where each instance lies before the mirror that is looked through.
    pub places: Lent<'w, Place>,
    /// The node of each instance.
    pub nodes: Lent<'w, usize>,
}

impl<'w> Outlook<'w> {
    /// Of a view; through a mirror, all that is seen of the world lies in `window`.
    pub fn new(
        (scene, pose): (&Scene, &Pose),
        (number, view): (usize, &View),
        window: Option<Body>,
        workspace: &'w Workspace,
    ) -> Self {
        let camera = &view.camera;
        let stalls = Stalls::new((scene, pose), view, window, workspace);
        let place = |instance: usize, node: usize| {
            let Some(window) = &view.through else { return Place::Before };
            let world_from_object = &pose.world_from_object[node];
            let corners = pose.bounds(scene, node).corners();
            let heights = corners.map(|corner| height(window.plane, world_from_object.transform_point3(corner)));
            if heights.iter().all(|height| *height <= window.slack) || !stalls.in_window(&stalls.boxes[instance]) {
                Place::Unseen
            } else if heights.iter().all(|height| *height > 2.0 * window.slack) {
                Place::Before
            } else {
                Place::Across
            }
        };
        let nodes = workspace.numbers.collect(scene.instances().map(|(node, ..)| node));
        let places = workspace.places.collect(nodes.iter().enumerate().map(|(instance, &node)| place(instance, node)));
        Self {
            view: number,
            near_pyramid: NearPyramid::of(camera.eye, camera.near_rectangle()),
            across: workspace.answers.collect(nodes.iter().map(|_| OnceCell::new())),
            stalls,
            receivers: scene.bounds(pose).union(&Aabb::around(camera.eye, camera.eye)),
            places,
            nodes,
        }
    }
}

impl<'a> Frame<'a> {
    /// The view whose steps are planned.
    pub(super) fn view(&self) -> &View {
        &self.plan.views[self.outlook.view]
    }

    /// The views that are seen in a view's mirrors.
    pub(super) fn children(&self, parent: usize) -> Vec<usize> {
        let seen_in = |view: &View| view.through.as_ref().is_some_and(|window| window.parent == parent);
        (0..self.plan.views.len()).filter(|&view| seen_in(&self.plan.views[view])).collect()
    }

    /// Another view's steps are planned from now on; gives what was known of the one before.
    pub(super) fn look_from(&mut self, view: usize) -> Outlook<'a> {
        let window = self.sights[view].body();
        let outlook = Outlook::new((self.scene, self.pose), (view, &self.plan.views[view]), Some(window), self.workspace);
        std::mem::replace(&mut self.outlook, outlook)
    }

    /// Whether reflections are drawn wherever they fall.
    pub(super) fn unbounded(&self) -> bool {
        let shows_light = matches!(self.settings.show, Show::Final | Show::Volumes | Show::Wireframe);
        self.settings.mirrors.mode == MirrorMode::Unbounded && shows_light
    }

    /// Whether reflections are drawn into textures first.
    pub(super) fn textured(&self) -> bool {
        let shows_light = matches!(self.settings.show, Show::Final | Show::Volumes | Show::Wireframe);
        self.settings.mirrors.mode == MirrorMode::Texture && shows_light
    }

    /// Plans a view for each mirror that is seen, and for each that is seen in that, as far as the bounces go; and takes
    /// the stencil's bits that tell them apart.
    pub(super) fn plan_views(&mut self) {
        let shows_mirrors = !matches!(
            self.settings.show,
            Show::Overflow | Show::Cases | Show::Bounds | Show::Rays | Show::Complexity | Show::Playground
        );
        let (mirrors, notes) = Mirrors::new(self.scene, self.pose, &self.settings.mirrors);
        self.plan.notes.extend(notes);
        if mirrors.is_empty() || !shows_mirrors {
            return;
        }
        if techniques::row(self.settings.technique).darkens.is_some() {
            self.plan.notes.push("mirrors are ordinary surfaces here: a dark quad knows no view".into());
            return;
        }
        let camera = self.plan.views[0].camera;
        self.sights = vec![Sight::of_eye(camera.eye, camera.clip_from_world(), self.plan.size)];
        self.mirrors = mirrors;
        if self.settings.mirrors.light == MirrorLight::Ambient {
            self.plan.reflections.ambient = more_ambient(self.scene, self.pose, &self.mirrors).to_array();
        }
        let mut grower = Grower { frame: self, too_small: 0, too_many: 0 };
        grower.grow(0);
        let Grower { too_small, too_many, .. } = grower;
        if too_many > 0 {
            self.plan.notes.push(format!("{too_many} mirrors are grey: {MOST_VIEWS} views are the most"));
        }
        let counted = &mut self.plan.reflections;
        counted.mirrors = self.mirrors.len();
        counted.bounces = self.mirrors.bounces();
        counted.worst_case = worst_case(counted.mirrors, counted.bounces);
        counted.too_small = too_small;
        let deepest = self.plan.views.iter().map(|view| view.path().len()).max().unwrap_or(0);
        if self.unbounded() {
            self.plan.notes.push("reflections are not bounded to their mirrors".into());
        } else if self.textured() {
            if self.plan.samples != 1 {
                self.plan.notes.push("reflections go into textures: 1 sample a pixel".into());
            }
            self.plan.samples = 1;
        } else if deepest > 0 {
            self.plan.budget = self.plan.budget.with_mirrors(u32::try_from(deepest).unwrap_or(u32::MAX));
            let budget = self.plan.budget;
            let has_extent = self.pose.lights.iter().any(|light| light.on && !light.extent.is_point());
            if self.settings.lighting.area_mode == AreaMode::Bits && has_extent {
                self.plan.notes.push("no bit for each point here: mirrors have taken bits of the stencil".into());
            }
            for view in &mut self.plan.views {
                if let Some(window) = &mut view.through {
                    window.level = budget.level(u32::try_from(window.path.len()).unwrap_or(0));
                }
            }
        }
    }
}

/// The tree of views, growing.
struct Grower<'f, 'a> {
    frame: &'f mut Frame<'a>,
    too_small: usize,
    too_many: usize,
}

impl Grower<'_, '_> {
    /// The views in one view's mirrors, each with all that is seen in it.
    fn grow(&mut self, at: usize) {
        let frame = &mut *self.frame;
        let (sight, seen_from) = (frame.sights[at].clone(), frame.plan.views[at].clone());
        if sight.bounces >= frame.mirrors.bounces() as usize {
            return;
        }
        let unbounded = frame.unbounded();
        let [width, height] = frame.plan.size;
        let texture = frame.textured().then(|| {
            let wide = frame.settings.mirrors.texture.clamp(LEAST_TEXTURE, MOST_TEXTURE).min(width);
            [wide, (u64::from(wide) * u64::from(height)).div_ceil(width.into()).max(1).min(height.into()) as u32]
        });
        let slack = SLACK * f64::from(frame.scene.bounds(frame.pose).radius());
        let mut found = Vec::new();
        for (number, mirror, posed) in frame.mirrors.posed() {
            let surface = crate::frame::Surface { instance: mirror.instance, primitive: mirror.primitive };
            if seen_from.through.as_ref().is_some_and(|window| window.exit == surface) {
                continue;
            }
            let Some(reflected) = sight.through(&posed.triangles, posed.plane, mirror.double_sided, posed.turn) else {
                continue;
            };
            if reflected.area < f64::from(frame.settings.mirrors.least_pixels) {
                self.too_small += 1;
                continue;
            }
            let mut seen = reflected.sight;
            if unbounded {
                seen.outline.clone_from(&sight.outline);
            }
            let Some(rect) = seen.rect() else { continue };
            let rect = texture.map_or(rect, |[width, height]| [0, 0, width, height]);
            let path: Vec<_> = seen_from.path().iter().copied().chain([number]).collect();
            let exit = frame.mirrors.exit(mirror);
            let window = Window { parent: at, path, surface, exit, plane: seen.near, turn: reflected.turn, slack, level: 0 };
            found.push((seen, rect, window, format!("{} > {}", seen_from.name, mirror.name)));
        }
        for (sight, rect, window, name) in found {
            let frame = &mut *self.frame;
            let view = frame.plan.views.len();
            if view >= MOST_VIEWS {
                self.too_many += 1;
                continue;
            }
            let camera = seen_from.camera.turned(&window.turn);
            let winding = if camera.mirrored { Winding::Cw } else { Winding::Ccw };
            let kept = texture.map(|_| view - 1);
            let picture = texture.unwrap_or(frame.plan.size);
            frame.plan.views.push(View { name, camera, winding, rect, picture, texture: kept, through: Some(window) });
            frame.sights.push(sight);
            self.grow(view);
        }
    }
}
