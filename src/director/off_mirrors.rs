//! Lights off mirrors: who stands in their way.

use super::Frame;
use super::views::SLACK;
use crate::frame::{Piece, Surface};
use crate::geometry::pixels::Grid;
use crate::geometry::planar::height;
use crate::geometry::reach::Body;
use crate::geometry::{Aabb, VolumeParts};
use crate::scene::OffMirror;
use crate::settings::Technique;
use crate::techniques::counting::LightCount;
use crate::techniques::culling::{self};
use crate::techniques::workspace::Casters;
use crate::techniques::{Caster, Row, off_mirror};

impl Frame<'_> {
    /// The count of a light that comes off a mirror: by z-fail, or wide where `row` is; without shadows where it counts
    /// none.
    pub(super) fn count_off_mirror(&mut self, row: &Row, light: usize, off: OffMirror, scissor: [u32; 4]) -> LightCount {
        let mut volumes = std::mem::take(&mut self.plan.volumes);
        let ask = self.ask(light, scissor);
        let count = match self.beam(light, off, scissor) {
            None => off_mirror::dark(&ask),
            Some(beam) => {
                let wide = row.technique == Technique::Wide;
                let by = crate::techniques::row(if wide { Technique::Wide } else { Technique::ZFail });
                let casters =
                    if row.groups.is_empty() { self.workspace.casters() } else { self.casters_off(light, off, scissor) };
                off_mirror::count(by, &beam, &casters, &ask, &mut volumes)
            }
        };
        self.plan.volumes = volumes;
        count
    }

    /// The mirror's outline as a caster before the light behind it.
    fn beam(&self, light: usize, off: OffMirror, scissor: [u32; 4]) -> Option<Caster<'_>> {
        off.plane?;
        let posed = &self.pose.lights[light];
        let audience = self.audience(posed, scissor);
        let within = audience.receivers_within(&self.outlook.receivers, self.view().camera.eye);
        let beam = self.caster(&audience, &within, (posed, off.instance), Piece::Primitive(off.primitive), None)?;
        let sight = culling::Sight { parts: VolumeParts::ALL, rect: scissor, cells: Grid::ALL, ..culling::Sight::NOTHING };
        Some(Caster { sight, ..beam })
    }

    /// What stands before the mirror, and its reflections.
    fn casters_off(&self, light: usize, off: OffMirror, scissor: [u32; 4]) -> Casters<'_> {
        let posed = &self.pose.lights[light];
        let mut casters = self.workspace.casters();
        let Some(plane) = off.plane.filter(|_| posed.shadows) else { return casters };
        let slack = SLACK * f64::from(self.scene.bounds(self.pose).radius());
        let audience = self.audience(posed, scissor);
        let within = audience.receivers_within(&self.outlook.receivers, self.view().camera.eye);
        let surface = Surface { instance: off.instance, primitive: off.primitive };
        // Through the very mirror that the light comes off, what is cut off a caster is not seen of it either.
        let same_mirror = |window: &crate::frame::Window| window.surface == surface && window.plane.dot(plane) > 0.0;
        let cut_alike = self.view().through.as_ref().is_some_and(same_mirror);
        for (instance, node) in self.casting() {
            let world_from_object = &self.pose.world_from_object[node];
            let corners = self.pose.bounds(self.scene, node).corners();
            let heights = corners.map(|corner| height(plane, world_from_object.transform_point3(corner)));
            if heights.iter().all(|height| *height <= slack) {
                continue;
            }
            let whole = heights.iter().all(|height| *height > slack);
            let piece = if whole { Piece::Whole } else { Piece::Before { plane, slack } };
            for reflected in [None, Some(plane)] {
                let Some(caster) = self.caster(&audience, &within, (posed, instance), piece, reflected) else { continue };
                let before_mirror = caster.before_mirror || cut_alike && !whole;
                casters.push(Caster { before_mirror, ..caster });
            }
        }
        casters
    }

    /// The pixels that light off a mirror can reach; `None` where its beam is off screen.
    pub(super) fn beam_rect(&self, light: usize, off: OffMirror) -> Option<[u32; 4]> {
        off.plane?;
        let (node, _, mesh) = self.scene.instances().nth(off.instance)?;
        let positions = self.pose.positions(self.scene, node);
        let outline = Aabb::from_points(mesh.triangles(off.primitive).flatten().map(|vertex| positions[vertex as usize]));
        let corners = outline.corners().map(|corner| self.pose.world_from_object[node].transform_point3(corner));
        let beam = Body::volume(&corners, (&self.pose.lights[light]).into(), None);
        let view = self.view();
        let frustum = Body::frustum(view.camera.eye, view.camera.near_rectangle());
        if !frustum.may_meet(&beam) {
            return None;
        }
        crate::geometry::frustum::hull_rect(beam.hull(), &view.camera.clip_from_world(), view.picture)
    }
}
