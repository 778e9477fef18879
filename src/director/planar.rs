//! Lights over surfaces that are laid, with planar shadows on the receivers among them: the order of each mode's passes.
//!
//! Nothing here asks which view is drawn: what is tagged are the pixels in which this view sees a receiver, and casters
//! are thrown through its own eye. So reflections have planar shadows too.

use super::{Frame, MID_GREY};
use crate::frame::stencil::{StencilOp, StencilState};
use crate::frame::{Step, VolumePlan};
use crate::geometry::LitPlane;
use crate::geometry::pixels::around;
use crate::settings::PlanarMode;
use crate::techniques::counting::LightCount;
use crate::techniques::decals::Decals;
use crate::techniques::own_bits::{Round, Shining};
use crate::techniques::planar::{self, Leaves, Receivers, Stand, Thrower};
use crate::techniques::show;
use crate::techniques::surfaces::{self, SurfaceGroup};
use crate::techniques::workspace::Reached;

/// A light, and what may throw its shadows.
struct Lamp {
    light: usize,
    rect: [u32; 4],
    throwers: Vec<Thrower>,
}

impl Frame<'_> {
    /// Finds the receivers, and takes the bits that tell them apart.
    pub(super) fn plan_receivers(&mut self) {
        let settings = &self.settings.planar;
        let (receivers, notes) = Receivers::new(self.scene, self.pose, settings);
        self.plan.notes.extend(notes);
        self.plan.budget = planar::budget(settings.mode, settings.hybrid, receivers.len(), self.plan.budget);
        self.receivers = receivers;
    }

    /// Whether shadows are planar, as far as there are any.
    pub(super) fn is_planar(&self) -> bool {
        self.settings.planar.mode != PlanarMode::Off
    }

    /// Every light, over surfaces that lie in ambient light.
    pub(super) fn shine_planar(&mut self, groups: &[&SurfaceGroup]) {
        // Where nothing is tagged decals need no value.
        let untagged = Decals::default();
        let mode = self.settings.planar.mode;
        let (stands, others) = self.receivers.apart(groups, if mode == PlanarMode::Naive { &untagged } else { &self.decals });
        let others: Vec<_> = others.iter().collect();
        let lamps: Vec<_> = (0..self.pose.lights.len()).filter_map(|light| self.lamp(light)).collect();
        match mode {
            PlanarMode::Off => {}
            PlanarMode::Naive => {
                self.add_all(&lamps, groups);
                for lamp in &lamps {
                    for stand in &stands {
                        self.throw(lamp, stand, Leaves::Dark);
                    }
                }
            }
            PlanarMode::StencilBlend => {
                self.add_all(&lamps, groups);
                // Tagged once for all lights: what one of them has darkened no other finds.
                self.each_tagged(&stands, true, |frame, stand, value| {
                    for lamp in &lamps {
                        frame.throw(lamp, stand, Leaves::DarkOnce(value));
                    }
                });
            }
            PlanarMode::StencilRelight => {
                // What a mirror reflects lies beneath its own look, and cannot be drawn anew.
                let (mirrors, plain): (Vec<_>, Vec<_>) = stands.into_iter().partition(Stand::reflects);
                let lit: Vec<_> = others.iter().copied().chain(plain.iter().flat_map(|stand| &stand.groups)).collect();
                self.add_all(&lamps, &lit);
                self.each_tagged(&plain, true, |frame, stand, value| frame.relight(&lamps, stand, value));
                self.each_tagged(&mirrors, true, |frame, stand, value| frame.light_in_turn(&lamps, stand, value));
            }
            PlanarMode::Multi => {
                self.add_all(&lamps, &others);
                self.each_tagged(&stands, true, |frame, stand, value| frame.light_in_turn(&lamps, stand, value));
            }
            PlanarMode::Hybrid => {
                for lamp in &lamps {
                    let once = self.count_hybrid(lamp, &stands);
                    let steps = self.lit(lamp.light, lamp.rect, groups, once);
                    self.extend(steps);
                }
            }
        }
        self.used = u8::MAX;
    }

    /// One light's verdict, or the stencil it is read from, by itself.
    pub(super) fn show_planar(&mut self, groups: &[SurfaceGroup], stencil: bool) {
        let whole = self.whole();
        self.clear_all([0.0; 4], 0);
        self.extend(surfaces::ambient(groups, whole));
        if !stencil {
            self.clear_color([MID_GREY, MID_GREY, MID_GREY, 1.0]);
        }
        self.planar_values(&groups.iter().collect::<Vec<_>>(), stencil);
        self.push(self.planar_picture(stencil));
    }

    /// What [`Self::planar_values`] left, as the picture.
    pub(super) fn planar_picture(&self, stencil: bool) -> Step {
        let whole = self.whole();
        if stencil { show::stencil_colors(self.plan.budget, 0, whole) } else { show::copy(whole) }
    }

    /// One light's verdict on surfaces whose depth is laid, in display values; for `stencil` only what it is read from.
    pub(super) fn planar_values(&mut self, groups: &[&SurfaceGroup], stencil: bool) {
        let light = self.settings.light;
        let Some(rect) = self.light_rect(light) else { return };
        let lamp = Lamp { light, rect, throwers: self.throwers(light, rect) };
        let (stands, others) = self.receivers.apart(groups, &self.decals);
        let said = |groups: &[&SurfaceGroup], lit, state| surfaces::said(groups.iter().copied(), light, rect, lit, state);
        let mode = self.settings.planar.mode;
        match mode {
            PlanarMode::Off => {}
            PlanarMode::Naive => {
                if stencil {
                    return;
                }
                self.extend(said(groups, true, StencilState::IGNORE));
                for stand in &stands {
                    self.throw(&lamp, stand, Leaves::Value([0.0, 0.0, 0.0, 1.0]));
                }
            }
            PlanarMode::StencilBlend | PlanarMode::StencilRelight | PlanarMode::Multi => {
                let step = if mode == PlanarMode::StencilBlend { StencilOp::Zero } else { StencilOp::IncrementWrap };
                if !stencil {
                    self.extend(said(&others.iter().collect::<Vec<_>>(), true, StencilState::IGNORE));
                    self.extend(said(
                        &stands.iter().flat_map(|stand| &stand.groups).collect::<Vec<_>>(),
                        false,
                        StencilState::IGNORE,
                    ));
                }
                self.each_tagged(&stands, false, |frame, stand, value| {
                    frame.throw(&lamp, stand, Leaves::Next(value, step));
                    if !stencil {
                        let lit =
                            said(&stand.groups.iter().collect::<Vec<_>>(), true, StencilState::on_receiver(frame.plan.budget));
                        frame.extend(planar::where_value(lit, value));
                    }
                });
            }
            PlanarMode::Hybrid => {
                _ = self.count_hybrid(&lamp, &stands);
                if !stencil {
                    let lit = StencilState::count_equals(self.plan.budget);
                    self.extend(said(groups, false, StencilState::IGNORE));
                    self.extend(said(groups, true, lit));
                }
            }
        }
        self.used = u8::MAX;
    }

    /// A light that shines, the pixels it can reach, and what may throw its shadows there.
    fn lamp(&self, light: usize) -> Option<Lamp> {
        let rect = self.light_rect(light).filter(|_| self.pose.lights[light].on)?;
        Some(Lamp { light, rect, throwers: self.throwers(light, rect) })
    }

    /// What may throw planar shadows in a light: all casters, but those that the hybrid counts.
    fn throwers(&self, light: usize, rect: [u32; 4]) -> Vec<Thrower> {
        let everywhere = self.settings.planar.mode == PlanarMode::Naive;
        let hybrid = self.settings.planar.mode == PlanarMode::Hybrid;
        let casters = self.casters(light, rect);
        let throwers =
            casters.iter().flat_map(|casters| casters.iter()).map(|caster| Thrower::new(caster, everywhere, self.whole()));
        throwers.filter(|thrower| !(hybrid && thrower.cut_out)).collect()
    }

    /// Every light on surfaces that take no shadows.
    fn add_all(&mut self, lamps: &[Lamp], groups: &[&SurfaceGroup]) {
        for lamp in lamps {
            let once = self.unused_bit(Some(lamp.light));
            let steps = self.lit(lamp.light, lamp.rect, groups, once);
            self.extend(steps);
        }
    }

    /// A light on surfaces, mirrors' own among them, where the stencil lets it through.
    fn lit(&self, light: usize, rect: [u32; 4], groups: &[&SurfaceGroup], stencil: StencilState) -> Vec<Step> {
        self.lit_among(&self.reached(light), (light, rect), groups, stencil)
    }

    /// The same on those of the surfaces that are `reached`.
    fn lit_among(
        &self,
        reached: &Reached<'_>,
        (light, rect): (usize, [u32; 4]),
        groups: &[&SurfaceGroup],
        stencil: StencilState,
    ) -> Vec<Step> {
        let shape = (&self.pose.lights[light]).into();
        let of_group = |group: &&SurfaceGroup| {
            let steps = surfaces::lit([*group], light, shape, rect, stencil, reached);
            match group.mirror() {
                None => steps,
                Some(mirror) if self.mirrors.is_perfect(mirror) => Vec::new(),
                Some(_) => self.mirrors.lit(group, steps),
            }
        };
        groups.iter().flat_map(of_group).collect()
    }

    /// Does something with each receiver while its pixels hold its value, as many at a time as there are values. `anew`
    /// says that the stencil holds something else before.
    fn each_tagged(&mut self, stands: &[Stand], anew: bool, mut each: impl FnMut(&mut Self, &Stand, u8)) {
        let (budget, whole) = (self.plan.budget, self.whole());
        for (round, some) in stands.chunks(budget.receivers().max(1)).enumerate() {
            if round > 0 {
                self.push(planar::forget(budget, whole));
            } else if anew {
                let why = "Only receivers' pixels will hold anything.";
                self.reset_view("receivers begin", why, 0);
            }
            for (number, stand) in some.iter().enumerate() {
                self.extend(planar::tag(stand, budget, budget.receiver(number), whole));
            }
            for (number, stand) in some.iter().enumerate() {
                each(self, stand, budget.receiver(number));
            }
        }
    }

    /// What a light's casters throw onto a receiver, and what they do not.
    fn thrown(&self, lamp: &Lamp, stand: &Stand) -> Vec<VolumePlan> {
        let posed = &self.pose.lights[lamp.light];
        let onto = LitPlane::of(stand.posed.plane, posed.into(), self.view().camera.eye, stand.posed.room);
        let of = |thrower: &Thrower| thrower.throw(onto, stand.surface, (lamp.light, posed.into()), self.outlook.view);
        lamp.throwers.iter().map(of).collect()
    }

    /// Throws a light's casters onto a receiver.
    fn throw(&mut self, lamp: &Lamp, stand: &Stand, leaves: Leaves) {
        let (mut parts, mut scissor) = (Vec::new(), None);
        for volume in self.thrown(lamp, stand) {
            if volume.projection.is_some() {
                parts.extend(planar::parts(self.plan.volumes.len()));
                scissor = Some(scissor.map_or(volume.rect, |scissor| around(scissor, volume.rect)));
            }
            self.plan.volumes.push(volume);
        }
        if let Some(scissor) = scissor {
            let step = planar::shadow(stand, lamp.light, parts, leaves, self.plan.budget, scissor);
            self.push(step);
        }
    }

    /// K section 5's last algorithm, for one receiver: each light is added where it is not blocked, which leaves all of the
    /// receiver's pixels with the value that shadowed ones had, and the next light finds the two in each other's place.
    fn light_in_turn<'l>(&mut self, lamps: impl IntoIterator<Item = &'l Lamp>, stand: &Stand, value: u8) {
        let (mut now, mut next) = (value, value + 1);
        for lamp in lamps {
            let step = if now < next { StencilOp::IncrementWrap } else { StencilOp::DecrementWrap };
            let mut reached = self.reached(lamp.light);
            if !stand.is_among(&reached.instances) {
                continue;
            }
            // All of its pixels, also where the light does not reach: they must go on together.
            reached.instances.fill(true);
            let groups = stand.groups.iter().collect::<Vec<_>>();
            let stencil = StencilState::move_on(self.plan.budget, step);
            let steps = self.lit_among(&reached, (lamp.light, self.whole()), &groups, stencil);
            if steps.is_empty() {
                continue;
            }
            self.throw(lamp, stand, Leaves::Next(now, step));
            self.extend(planar::where_value(steps, now));
            (now, next) = (next, now);
        }
    }

    /// Where any light is blocked a receiver is drawn anew (K section 5), and each light added again that is not.
    fn relight(&mut self, lamps: &[Lamp], stand: &Stand, value: u8) {
        let (budget, whole) = (self.plan.budget, self.whole());
        let reaches: Vec<_> = lamps.iter().filter(|lamp| stand.is_among(&self.reached(lamp.light).instances)).collect();
        for lamp in &reaches {
            self.throw(lamp, stand, Leaves::Next(value, StencilOp::IncrementWrap));
        }
        // With one light alone nothing is left to be added, and the pixels may be as they were.
        let alone = reaches.len() < 2;
        let done = StencilState::move_on(budget, StencilOp::DecrementWrap);
        let stencil = if alone { done } else { StencilState::on_receiver(budget) };
        self.extend(planar::relit(stand, stencil, value + 1, whole));
        if !alone {
            self.light_in_turn(reaches, stand, value + 1);
        }
    }

    /// Counts cut-outs' volumes, and adds to the verdict what all other casters throw onto receivers; gives what lets the
    /// light through then.
    fn count_hybrid(&mut self, lamp: &Lamp, stands: &[Stand]) -> StencilState {
        let part = self.settings.planar.hybrid;
        let count = if part.has_volumes() { self.count(lamp.light) } else { LightCount::default() };
        let falls = |stand| self.thrown(lamp, stand).iter().any(|volume| volume.projection.is_some());
        let planar = part.has_planar() && stands.iter().any(falls);
        if count.steps.is_empty() && !planar {
            // Why nothing is thrown, for the record.
            stands.iter().for_each(|stand| self.plan.volumes.extend(self.thrown(lamp, stand)));
            return self.unused_bit(Some(lamp.light));
        }
        let budget = if count.steps.is_empty() { self.plan.budget } else { count.budget };
        let shining = Shining { light: lamp.light, rect: lamp.rect, budget: Some(budget) };
        self.start_round(&Round { base: count.base, steps: Vec::new(), lights: vec![shining] });
        self.extend(count.steps);
        if planar {
            self.each_tagged(stands, false, |frame, stand, value| frame.throw(lamp, stand, Leaves::Verdict(value)));
        }
        StencilState::light_once(budget)
    }
}
