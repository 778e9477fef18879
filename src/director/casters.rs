//! One light in the view that is planned: where it reaches, what casts before it, and the count of that.

use std::cell::OnceCell;

use glam::DVec4;

use super::Frame;
use super::views::Outlook;
use crate::frame::Piece;
use crate::geometry::ending::ending_plane;
use crate::geometry::pixels::{Grid, common};
use crate::geometry::planar::reflection;
use crate::geometry::{Aabb, Body};
use crate::scene::{LightKind, PosedLight};
use crate::settings::Show;
use crate::techniques::counting::LightCount;
use crate::techniques::culling::{Audience, Interest, light_rect};
use crate::techniques::surfaces::Place;
use crate::techniques::workspace::{Casters, Reached};
use crate::techniques::{self, Caster, counting, planar, show};

impl<'a> Frame<'a> {
    /// The pixels a light can reach; `None` where its bounds are off screen.
    pub(super) fn light_rect(&self, light: usize) -> Option<[u32; 4]> {
        let clip_from_world = self.view().camera.clip_from_world();
        let bounds = self.settings.culling.light_bounds;
        let rect =
            light_rect(&self.pose.lights[light], bounds, self.settings.show.into(), &clip_from_world, self.view().picture)?;
        let rect = match self.pose.lights[light].off {
            Some(off) if Interest::from(self.settings.show) == Interest::Lit => common(rect, self.beam_rect(light, off)?)?,
            _ => rect,
        };
        common(rect, self.view().rect)
    }

    /// Which instances lie, at least in part, within a light's range.
    pub(super) fn reached(&self, light: usize) -> Reached<'a> {
        let light = &self.pose.lights[light];
        let within = |node| {
            !light.range.is_finite() || self.pose.world_bounds(self.scene, node).distance_to(light.position) <= light.range
        };
        let workspace = self.workspace;
        let instances = workspace.flags.collect(self.outlook.nodes.iter().map(|&node| within(node)));
        Reached { instances, lists: &workspace.surfaces }
    }

    /// How the chosen technique counts this light's volumes.
    pub(super) fn count(&mut self, light: usize) -> LightCount {
        self.count_by(techniques::row(self.settings.technique), light)
    }

    pub(super) fn count_by(&mut self, row: &techniques::Row, light: usize) -> LightCount {
        let scissor = self.light_rect(light);
        let count = match (scissor, self.pose.lights[light].off) {
            (None, _) => None,
            (Some(_), None) if row.groups.is_empty() => None,
            (Some(scissor), Some(off)) => Some(self.count_off_mirror(row, light, off, scissor)),
            (Some(scissor), None) => {
                let mut volumes = std::mem::take(&mut self.plan.volumes);
                let mut casters = self.casters(light, scissor);
                if let Some(casters) = casters.as_mut().filter(|_| self.is_planar()) {
                    casters.retain(planar::is_cut_out);
                }
                let count = casters.map(|casters| counting::count_light(row, &casters, &self.ask(light, scissor), &mut volumes));
                self.plan.volumes = volumes;
                count
            }
        };
        let Some(count) = count else { return LightCount { budget: self.plan.budget.without_bounds(), ..LightCount::default() } };
        // The points of one light have much the same to say.
        let about = format!("light {}: ", self.pose.lights[light].of);
        if !self.plan.notes.iter().any(|note| note.starts_with(&about)) {
            self.plan.notes.extend(count.notes.iter().cloned());
        }
        count
    }

    /// Counts one caster after the other, and darkens what is already lit where one counts: everywhere,
    /// for a rectangle that ends with the light's range would show.
    pub(super) fn darken(&mut self, light: usize, color: [f32; 4]) {
        let whole = self.whole();
        let row = techniques::row(self.settings.technique);
        let mut volumes = std::mem::take(&mut self.plan.volumes);
        let mut steps = Vec::new();
        if let Some(casters) = self.light_rect(light).and_then(|rect| self.casters(light, rect)) {
            for caster in casters.chunks(1) {
                let count = counting::count_light(row, caster, &self.ask(light, whole), &mut volumes);
                if !count.steps.is_empty() {
                    steps.extend(count.steps);
                    steps.push(show::dark(light, color, self.plan.budget, whole));
                }
            }
        }
        self.plan.volumes = volumes;
        self.extend(steps);
    }

    /// What casts shadows before a light that is counted in `scissor`; `None` where nothing does.
    pub(super) fn casters(&self, light: usize, scissor: [u32; 4]) -> Option<Casters<'_>> {
        let posed = &self.pose.lights[light];
        if !posed.shadows {
            return None;
        }
        let audience = self.audience(posed, scissor);
        let within = audience.receivers_within(&self.outlook.receivers, self.view().camera.eye);
        let caster = |(instance, _)| self.caster(&audience, &within, (posed, instance), Piece::Whole, None);
        let mut casters = self.workspace.casters();
        casters.extend(self.casting().filter_map(caster));
        Some(casters)
    }

    /// What casts shadows: its number among the instances, and its node.
    pub(super) fn casting(&self) -> impl Iterator<Item = (usize, usize)> {
        let casts = |mesh: &crate::scene::Mesh| {
            !mesh.indices.is_empty() && mesh.primitives.iter().any(|primitive| primitive.casts_shadow)
        };
        let casting = self.scene.instances().enumerate().filter(move |(_, (_, node, mesh))| node.casts_shadow && casts(mesh));
        casting.map(|(instance, (node, ..))| (instance, node))
    }

    /// A piece of an instance, perhaps reflected, as a caster before a light; its volume need not go farther than `within`.
    pub(super) fn caster<'s>(
        &'s self,
        audience: &Audience<'_>,
        within: &Aabb,
        (light, instance): (&'s PosedLight, usize),
        piece: Piece,
        reflected: Option<DVec4>,
    ) -> Option<Caster<'s>> {
        let Outlook { receivers, near_pyramid, across, places, nodes, .. } = &self.outlook;
        let view = self.view();
        let node_index = *nodes.get(instance)?;
        let node = &self.scene.nodes[node_index];
        let mesh = &self.scene.meshes[node.mesh?];
        let world_from_object = self.pose.world_from_object[node_index];
        let world_from_object = reflected.map_or(world_from_object, |plane| reflection(plane) * world_from_object);
        let bounds = self.pose.bounds(self.scene, node_index);
        let corners = bounds.corners().map(|corner| world_from_object.transform_point3(corner));
        let ends_on = |within| match light.kind {
            LightKind::Directional => None,
            // The far plane is to show what it does to volumes without end.
            _ if view.camera.far.is_some() => None,
            _ => ending_plane(light.position, corners, within),
        };
        let end = ends_on(within).or_else(|| ends_on(receivers));
        let in_range = bounds.transformed(&world_from_object).distance_to(light.position) <= light.range;
        let own = reflected.is_none().then_some(instance);
        let reflection = own.is_none().then(|| Body::boxed(&bounds, &world_from_object));
        let body = reflection.as_ref().unwrap_or(&self.outlook.stalls.boxes[instance]);
        Some(Caster {
            capabilities: self.capabilities,
            scene: self.scene,
            pose: self.pose,
            world_from_object,
            piece,
            reflected,
            view,
            view_number: self.outlook.view,
            before_mirror: places[instance] == Place::Before,
            near_pyramid,
            across: &across[instance],
            instance,
            node_index,
            node,
            mesh,
            light,
            sight: audience.sight((own, body), &corners, mesh.indices.len() / 3, in_range, end),
            end,
            receivers,
            eye_count: OnceCell::new(),
            cutout: OnceCell::new(),
        })
    }

    pub(super) fn ask(&self, light: usize, scissor: [u32; 4]) -> counting::Ask<'_> {
        let counting = self.settings.counting;
        let budget = self.plan.budget;
        let windowed = self.settings.culling.on && self.settings.culling.footprints && !self.settings.culling.caster_scissors;
        let solid = if budget.beyond_mask == 0 { None } else { self.solid(light) };
        counting::Ask {
            capabilities: self.capabilities,
            light,
            scissor,
            apart: self.settings.culling.caster_scissors,
            grid: windowed.then(|| Grid::new(self.view().picture)),
            samples: self.plan.samples,
            budget: if solid.is_some() { budget } else { budget.without_bounds() },
            solid,
            overflow: counting.overflow,
            values: self.settings.show == Show::Stencil,
            workspace: self.workspace,
        }
    }

    /// What one light's shadows could matter to in the view.
    pub(super) fn audience<'s>(&'s self, posed: &'s PosedLight, scissor: [u32; 4]) -> Audience<'s> {
        let (view, interest) = (self.view(), self.settings.show.into());
        Audience::new(
            posed,
            (&self.outlook.stalls, self.workspace),
            view,
            interest,
            &self.settings.culling,
            scissor,
            view.picture,
        )
    }
}
