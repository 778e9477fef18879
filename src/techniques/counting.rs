//! From one decision per caster to the steps that put a light's count into the stencil.
//!
//! Every volume's parts are grouped by the state they need (method, part, winding), so that a frame
//! has a handful of counting steps a light however many casters there are. Which states those are
//! the technique says: its [`Group`]s.

use std::cell::OnceCell;

use glam::{DAffine3, DVec3, DVec4};

use super::culling::Sight;
use super::overflow::{self, Way};
use super::windows::{Footprint, Window, windows};
use super::workspace::Workspace;
use super::{Row, depth_bounds, wide};
use crate::frame::plan::View;
use crate::frame::state::{Blend, Cull, Depth, NearPlane, State, Winding};
use crate::frame::stencil::{BitBudget, StencilState};
use crate::frame::{
    Capabilities, Cutout, Draw, DrawSet, List, Method, Part, Piece, Program, Reason, Step, Target, VolumePart, VolumePlan,
};
use crate::geometry::clamping;
use crate::geometry::eye_count::{EyeCount, holding_count, inside_solid};
use crate::geometry::frustum::NearPyramid;
use crate::geometry::light_in_object;
use crate::geometry::near_rectangle::may_shadow;
use crate::geometry::pixels::{Grid, around, common};
use crate::geometry::{Aabb, Enclosure};
use crate::scene::{AlphaMode, Mesh, Node, Pose, PosedLight, Scene};
use crate::settings::{Backend, Overflow, Technique};

/// One caster before one light, as a technique's `decide` sees it.
pub struct Caster<'a> {
    /// The device.
    pub capabilities: &'a Capabilities,
    /// The scene it stands in.
    pub scene: &'a Scene,
    /// And where everything is now.
    pub pose: &'a Pose,
    /// Object space to world space: of a reflected caster to where it seems to be.
    pub world_from_object: DAffine3,
    /// Which part of it casts.
    pub piece: Piece,
    /// The plane it is reflected in.
    pub reflected: Option<DVec4>,
    /// All of it lies before the mirror that the view looks through.
    pub before_mirror: bool,
    /// The view it is counted for.
    pub view: &'a View,
    /// Its number among the plan's.
    pub view_number: usize,
    /// Eye and near rectangle of that view.
    pub near_pyramid: &'a NearPyramid,
    /// What [`Self::across_near_plane`] found, once asked: the same for every light.
    pub across: &'a OnceCell<bool>,
    /// Its number among the scene's instances.
    pub instance: usize,
    /// Its node's number.
    pub node_index: usize,
    /// Its node.
    pub node: &'a Node,
    /// Its mesh.
    pub mesh: &'a Mesh,
    /// The light.
    pub light: &'a PosedLight,
    /// What holds everything that could receive its shadow, and the eye.
    pub receivers: &'a Aabb,
    /// What of its volume matters.
    pub sight: Sight,
    /// The plane on which its volume may end without a visible pixel's count changing.
    pub end: Option<DVec4>,
    /// What [`Self::holds_eye`] found, once asked.
    pub eye_count: OnceCell<Option<i32>>,
    /// What its volume is thrown from, once a technique decided that it is not its own silhouette.
    pub cutout: OnceCell<Cutout>,
}

impl Caster<'_> {
    /// Whether the caster may reach into the pyramid between the eye and the near rectangle, or hold
    /// the eye. Conservative: may say yes wrongly, never no.
    #[must_use]
    pub fn across_near_plane(&self) -> bool {
        *self.across.get_or_init(|| {
            let world_from_object = &self.world_from_object;
            let bounds = self.pose.bounds(self.scene, self.node_index);
            if !self.near_pyramid.may_touch(&bounds, world_from_object) {
                return false;
            }
            let (topology, positions) = (&self.mesh.topology, self.pose.positions(self.scene, self.node_index));
            let eye = world_from_object.inverse().transform_point3(self.view.camera.eye);
            self.near_pyramid.may_touch_surface(topology, positions, world_from_object)
                || inside_solid(topology, positions, eye) != Some(false)
        })
    }

    /// Whether every light-facing triangle of the caster is in the depth buffer, or something nearer
    /// is: it lies before the mirror that is looked through, its materials are opaque and either drawn from both sides, or the mesh is solid, so that
    /// a triangle seen from behind always has one seen from the front before it.
    #[must_use]
    pub fn surface_covers(&self) -> bool {
        if !self.before_mirror || self.reflected.is_some() {
            return false;
        }
        let solid = self.mesh.topology.report().is_solid();
        self.mesh.primitives.iter().filter(|primitive| primitive.casts_shadow).all(|primitive| {
            let material = &self.scene.materials[primitive.material];
            material.alpha == AlphaMode::Opaque && (material.double_sided || solid)
        })
    }

    /// How many of this caster's volumes hold the eye; `None` where rounding could decide.
    #[must_use]
    pub fn holds_eye(&self) -> Option<i32> {
        *self.eye_count.get_or_init(|| self.count_at_eye())
    }

    fn count_at_eye(&self) -> Option<i32> {
        let world_from_object = self.world_from_object;
        let eye = world_from_object.inverse().transform_point3(self.view.camera.eye);
        let light = light_in_object(&world_from_object, self.light);
        let bounds = self.pose.bounds(self.scene, self.node_index);
        let toward = if light.w == 0.0 { light.truncate() } else { light.truncate() - eye };
        let reach = if light.w == 0.0 { f64::INFINITY } else { 1.0 };
        if !bounds.meets_segment(eye, toward, reach) {
            return Some(0);
        }
        let topology = &self.mesh.topology;
        match holding_count(topology, self.pose.positions(self.scene, self.node_index), light, eye) {
            EyeCount::Count(count) => Some(count),
            EyeCount::Ambiguous => None,
        }
    }

    /// The light in object space: a point with w = 1, or the direction towards it with w = 0.
    #[must_use]
    pub fn light_in_object(&self) -> DVec4 {
        light_in_object(&self.world_from_object, self.light)
    }

    /// The corners, in object space, of what holds everything that could receive its shadow, and the
    /// eye.
    #[must_use]
    pub fn receivers_in_object(&self) -> [DVec3; 8] {
        let object_from_world = self.world_from_object.inverse();
        self.receivers.corners().map(|corner| object_from_world.transform_point3(corner))
    }

    /// Whether some of it may lie between the light and the near rectangle. Conservative: may say yes
    /// wrongly, never no.
    #[must_use]
    pub fn may_shadow_near_rectangle(&self) -> bool {
        let bounds = self.pose.bounds(self.scene, self.node_index);
        let rectangle = self.view.camera.near_rectangle();
        may_shadow(self.light.into(), rectangle, &bounds, &self.world_from_object)
    }

    /// The front's winding on screen.
    #[must_use]
    pub fn winding(&self) -> Winding {
        self.view.winding.through(self.world_from_object.matrix3.determinant())
    }
}

/// Which light is counted, where, and in what.
#[derive(Debug, Clone, Copy)]
pub struct Ask<'a> {
    /// The device.
    pub capabilities: &'a Capabilities,
    /// An index into the pose's lights.
    pub light: usize,
    /// Pixels.
    pub scissor: [u32; 4],
    /// Each volume is counted in a step of its own.
    pub apart: bool,
    /// The cells of the picture, where volumes are counted in [`windows`].
    pub grid: Option<Grid>,
    /// Per pixel.
    pub samples: u32,
    /// The bits there are to count in.
    pub budget: BitBudget,
    /// What bounds the light in depth, where that is marked: the budget then has a bit for it.
    pub solid: Option<Enclosure>,
    /// What is done where they are too few.
    pub overflow: Overflow,
    /// The count itself is shown, not only whether it is zero.
    pub values: bool,
    /// Where lists are made.
    pub workspace: &'a Workspace,
}

/// The volumes of one light, decided.
#[derive(Debug, Default)]
pub struct LightCount {
    /// What the stencil must hold everywhere before the first volume: how many of the volumes that
    /// are counted from the eye hold the eye, modulo the field; and that it lies beyond the light's
    /// bounds, until those are marked.
    pub base: u8,
    /// The counting steps, in order.
    pub steps: Vec<Step>,
    /// The bits that hold the verdict: all zero where the light shines.
    pub budget: BitBudget,
    /// What a user should know of it.
    pub notes: Vec<String>,
}

/// Casters of one light in `view`, each decided by `row`; their plans are appended to `volumes`.
pub fn count_light(row: &Row, casters: &[Caster<'_>], ask: &Ask<'_>, volumes: &mut Vec<VolumePlan>) -> LightCount {
    let first = volumes.len();
    let light = ask.light;
    let nothing = || LightCount { budget: ask.budget.without_bounds(), ..LightCount::default() };
    if row.groups.is_empty() {
        return nothing();
    }
    // Casters that are counted, by their numbers; volumes of theirs, by theirs; and of each volume, which caster's it is.
    let [mut counted, mut numbers, mut places] = [(); 3].map(|()| ask.workspace.numbers.lend());
    volumes.reserve(casters.len());
    for (number, caster) in casters.iter().enumerate() {
        let decided = caster.sight.dropped.map(|reason| (Method::Dropped, reason)).or_else(|| (row.decide)(caster));
        let Some((method, reason)) = decided else { continue };
        let whole = planned(row, caster, light, (method, reason));
        if method == Method::Dropped {
            volumes.push(whole);
            continue;
        }
        let first = volumes.len();
        if row.clamps(&whole) && !caster.sight.pieces.is_empty() {
            volumes.extend(caster.sight.pieces.iter().map(|piece| clamped(&whole, piece, caster)));
        } else {
            volumes.push(whole);
        }
        places.extend((first..volumes.len()).map(|_| counted.len()));
        numbers.extend(first..volumes.len());
        counted.push(number);
    }
    if counted.is_empty() {
        return nothing();
    }

    let decision = overflow::decide(row, (casters, &counted), ask);
    let notes = decision.note.into_iter().collect();
    let (batch_of, batches) = match decision.way {
        Way::Wide if row.technique != Technique::Wide => {
            volumes.truncate(first);
            return LightCount { notes, ..count_light(&wide::ROW, casters, ask, volumes) };
        }
        Way::Plain | Way::Wide => (None, 1),
        Way::Batches(batch_of, batches) => (Some(batch_of), batches),
    };
    let budget = if batches > 1 { ask.budget.batched() } else { ask.budget };
    let mut count = LightCount { base: 0, steps: Vec::new(), budget, notes };
    for batch in 0..batches {
        let is_in_it = |place: &usize| batch_of.as_ref().is_none_or(|batch_of| batch_of[places[*place]] == batch);
        let members = ask.workspace.numbers.collect((0..numbers.len()).filter(is_in_it).map(|place| numbers[place]));
        let base = members.iter().map(|&volume| volumes[volume].holds_eye).fold(0u8, |sum, holds_eye| {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the count is modulo the field")]
            sum.wrapping_add(holds_eye as u8)
        });
        let base = match budget.count_mask {
            0 => (base & 1) * budget.verdict_mask,
            field => base & field,
        };
        if batch == 0 {
            count.base = base | budget.beyond();
        } else {
            count.steps.extend(between_batches(batch, base, budget, ask));
        }
        let footprint = |&place: &usize| {
            let volume = &volumes[numbers[place]];
            let windowed = is_in_it(&place) && row.exact && volume.adds_nothing_elsewhere();
            let triangles = casters[counted[places[place]]].mesh.indices.len() / 3;
            windowed.then(|| Footprint::of(volume.cells, volume.scissor(ask.scissor), triangles))
        };
        let footprints = ask.workspace.footprints.collect((0..numbers.len()).filter_map(|place| footprint(&place)));
        let windows = ask.grid.map(|grid| windows(&footprints, grid, ask.workspace));
        count.steps.extend(steps(row, (&members, windows.as_deref().map_or(&[], Vec::as_slice)), volumes, budget, ask));
    }
    if row.technique != Technique::Wide && budget.is_points() && budget.count_mask != 0 {
        count.steps.push(collapse(format!("light {light}: collapse into its bit"), budget, ask));
    }
    if row.technique == Technique::Wide {
        count.steps.insert(0, wide::begin(light));
        count.steps.extend(wide::finish(ask));
    }
    if let Some(solid) = ask.solid {
        count.steps.insert(0, depth_bounds::mark(light, solid, budget, ask.scissor));
    }
    count
}

/// The plan of one caster's volume.
pub(super) fn planned(row: &Row, caster: &Caster<'_>, light: usize, (method, reason): (Method, Reason)) -> VolumePlan {
    let cutout = caster.cutout.get().copied();
    VolumePlan {
        view: caster.view_number,
        instance: caster.instance,
        light,
        method,
        reason,
        case: caster.sight.case,
        parts: caster.sight.parts,
        rect: caster.sight.rect,
        cells: caster.sight.cells,
        holds_eye: if method == Method::ExactZPass { caster.holds_eye().unwrap_or(0) } else { 0 },
        outline: row.outline,
        extrusion: row.extrusion,
        end: if cutout.is_none() && row.extrusion.is_none() { caster.end } else { None },
        start: None,
        closed: false,
        piece: caster.piece,
        reflected: caster.reflected,
        cutout,
        turns: matches!(caster.piece, Piece::Primitive(_)) || !caster.mesh.topology.report().is_solid(),
        winding: caster.winding(),
        projection: None,
        silhouette: Backend::Cpu,
        flaw: None,
    }
}

/// A piece of a volume that is planned as a whole.
fn clamped(whole: &VolumePlan, piece: &clamping::Piece, caster: &Caster<'_>) -> VolumePlan {
    let eye = caster.view.camera.eye.extend(1.0);
    // Between its planes it holds the eye as often as the whole does, and beyond them not at all.
    let between = piece.start.is_none_or(|start| start.dot(eye) > 0.0) && piece.end.dot(eye) < 0.0;
    VolumePlan {
        start: piece.start,
        end: Some(piece.end),
        closed: piece.closed,
        rect: piece.drawn,
        cells: Grid::new(caster.view.picture).reached_by(piece.matters),
        holds_eye: if between { whole.holds_eye } else { 0 },
        ..whole.clone()
    }
}

/// The counting steps of some volumes, by their numbers. Those that need not be counted everywhere are in `windows`, where
/// there are any.
pub(super) fn steps(
    row: &Row,
    (members, windows): (&[usize], &[Window]),
    volumes: &[VolumePlan],
    budget: BitBudget,
    ask: &Ask<'_>,
) -> Vec<Step> {
    let mut steps = Vec::new();
    for group in row.groups.iter().copied().flatten() {
        for winding in [Winding::Ccw, Winding::Cw] {
            let counted = members
                .iter()
                .map(|&index| (index, &volumes[index]))
                .filter(|(_, volume)| volume.method == group.method && volume.winding == winding);
            let parts = counted
                .flat_map(|(index, volume)| group.parts.iter().map(move |&part| (volume, VolumePart::whole(index, part))))
                .filter(|(volume, part)| volume.has(part.part) && volume.shows(part.part));
            let found = ask.workspace.found_parts.collect(parts.map(|(_, part)| part));
            let windowed = |part: &VolumePart| !windows.is_empty() && volumes[part.volume].adds_nothing_elsewhere();
            let everywhere = found.iter().copied().filter(|part| !windowed(part));
            let in_windows = windows.iter().flat_map(|window| {
                let matters = |part: &&VolumePart| windowed(part) && volumes[part.volume].cells & window.cells != 0;
                found.iter().filter(matters).map(|part| VolumePart { window: Some(window.rect), ..*part })
            });
            let parts = ask.workspace.found_parts.collect(everywhere.chain(in_windows));
            let shares = |a: &VolumePart, b: &VolumePart| !ask.apart || a.volume == b.volume;
            for parts in parts.chunk_by(shares) {
                // What is wrong somewhere is left to be wrong everywhere.
                let of_volume =
                    |part: &VolumePart| if row.exact { volumes[part.volume].scissor(ask.scissor) } else { ask.scissor };
                let whole = parts.iter().map(of_volume).reduce(around).unwrap_or(ask.scissor);
                let windows = parts.iter().map(|part| part.window.unwrap_or(whole)).reduce(around);
                let Some(rect) = common(whole, windows.unwrap_or(whole)) else { continue };
                steps.push(group.step(ask.light, winding, rect, budget, ask.workspace.parts.collect(parts.iter().copied())));
            }
        }
    }
    steps
}

/// What a batch leaves becomes one bit, and the field starts anew.
pub(super) fn between_batches(batch: usize, base: u8, budget: BitBudget, ask: &Ask<'_>) -> Vec<Step> {
    let collapse = collapse(format!("light {}: collapse batch {batch}", ask.light), budget, ask);
    let start = (base != 0).then(|| {
        full_screen(
            format!("light {}: start batch {} at {base}", ask.light, batch + 1),
            "So many of this batch's volumes hold the eye, where counting starts.",
            Program::StencilOnly,
            StencilState::set_count(budget),
            base,
            ask,
        )
    });
    [collapse].into_iter().chain(start).collect()
}

fn collapse(label: String, budget: BitBudget, ask: &Ask<'_>) -> Step {
    full_screen(
        label,
        "A count that is not zero sets the verdict bit and becomes zero: the field is free for what comes next.",
        Program::StencilOnly,
        StencilState::collapse(budget),
        budget.verdict_mask,
        ask,
    )
}

/// A step over all of the light's pixels that changes the stencil only.
pub(super) fn full_screen(
    label: String,
    why: &str,
    program: Program,
    stencil: StencilState,
    reference: u8,
    ask: &Ask<'_>,
) -> Step {
    let draw = Draw {
        state: State { stencil, ..State::FLAT },
        stencil_reference: reference,
        light: Some(ask.light),
        ..Draw::plain(program, DrawSet::FullScreen, ask.scissor)
    };
    Step::drawing(label, why, draw)
}

/// Parts of volumes that are counted by the same state: one step for each winding.
#[derive(Clone, Copy)]
pub struct Group {
    /// Whose parts.
    pub method: Method,
    /// Which of them.
    pub parts: &'static [Part],
    /// A few words, for the step.
    pub label: &'static str,
    /// One sentence, for the step.
    pub why: &'static str,
    /// Which shaders.
    pub program: Program,
    /// Test and operations.
    pub stencil: fn(BitBudget) -> StencilState,
    /// The depth test.
    pub depth: Depth,
    /// Which side is left out.
    pub cull: Cull,
    /// What happens before the near plane.
    pub near_plane: NearPlane,
    /// How colour is combined, for counting by colour.
    pub color: Option<Blend>,
    /// Where it is counted.
    pub target: Target,
    /// What the program counts with, where it asks.
    pub constant: [f32; 4],
}

impl Group {
    /// What groups mostly are: volumes drawn from both sides, faces before the surface told from
    /// those behind. Not a group by itself.
    pub const PLAIN: Self = Self {
        method: Method::Dropped,
        parts: &[],
        label: "",
        why: "",
        program: Program::Volume,
        stencil: |_| StencilState::IGNORE,
        depth: Depth::NEARER,
        cull: Cull::None,
        near_plane: NearPlane::Clip,
        color: None,
        target: Target::Scene,
        constant: [0.0; 4],
    };

    fn step(&self, light: usize, winding: Winding, scissor: [u32; 4], budget: BitBudget, parts: List<VolumePart>) -> Step {
        let mirrored = if winding == Winding::Cw { ", mirrored" } else { "" };
        let faces = match (self.program, self.cull) {
            (Program::VolumeFronts, _) | (_, Cull::Back) => ", fronts",
            (Program::VolumeBacks, _) | (_, Cull::Front) => ", backs",
            _ => "",
        };
        let stencil = (self.stencil)(budget);
        let state = State {
            depth: self.depth,
            // A point without bits to count in has one to turn over.
            stencil: if budget.count_mask == 0 { stencil.turning_over(budget.verdict_mask) } else { stencil },
            color: self.color,
            cull: self.cull,
            winding,
            near_plane: self.near_plane,
        };
        let draw = Draw {
            target: self.target,
            state,
            light: Some(light),
            constant: self.constant,
            ..Draw::plain(self.program, DrawSet::Volumes(parts), scissor)
        };
        Step::drawing(format!("light {light}: {}{faces}{mirrored}", self.label), self.why, draw)
    }
}
