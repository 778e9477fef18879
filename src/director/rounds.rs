//! Who shares the stencil: lights in rounds, and what must be cleared between them.
//!
//! A light that casts shadows has the stencil for itself, and the points of one that has a size may share it
//! ([`crate::techniques::own_bits`]). What shines without having been counted takes any bit that nobody used,
//! to mark the pixels it was added to.

use super::Frame;
use crate::frame::stencil::{BitBudget, StencilState};
use crate::geometry::pixels::around;
use crate::settings::AreaMode;
use crate::techniques::counting::LightCount;
use crate::techniques::own_bits::{self, Round};
use crate::techniques::{self, counting};

/// What one light's shadows are shown by.
#[derive(Default)]
pub(super) struct Counted {
    /// Of the light that is looked at.
    pub count: LightCount,
    /// The bits of its points in the stencil, where each has one of its own.
    pub points_mask: u8,
}

impl Frame<'_> {
    /// What shines, in order, with what it must be counted by first.
    pub(super) fn rounds(&mut self) -> Vec<Round> {
        let darkens = techniques::row(self.settings.technique).darkens.is_some();
        let mut rounds = Vec::new();
        for light in (0..self.pose.lights.len()).filter(|&light| self.pose.lights[light].on) {
            let off_mirror = self.pose.lights[light].off.is_some();
            // A dark quad knows no beams.
            let Some(rect) = self.light_rect(light).filter(|_| !(darkens && off_mirror)) else { continue };
            self.plan.reflections.lights += usize::from(off_mirror && self.outlook.view == 0);
            let points = if darkens { Vec::new() } else { self.points_with_bits(light) };
            match points.first() {
                // Lights are lit before they are darkened.
                None if darkens => rounds.push(Round::of_one(light, rect, LightCount::default())),
                None => rounds.push(Round::of_one(light, rect, self.count(light))),
                Some(first) if *first == light => rounds.extend(self.count_points(&points)),
                Some(_) => {}
            }
        }
        rounds
    }

    /// The points of the light that `light` is one of, where they have a stencil bit each; none where they
    /// have not.
    fn points_with_bits(&self, light: usize) -> Vec<usize> {
        let posed = &self.pose.lights[light];
        let bits = self.settings.lighting.area_mode == AreaMode::Bits && self.plan.budget.mirror_mask == 0;
        if !bits || !posed.shadows || posed.extent.is_point() || posed.off.is_some() {
            return Vec::new();
        }
        let points = (0..self.pose.lights.len()).filter(|&point| self.pose.lights[point].of == posed.of);
        points.filter(|&point| self.light_rect(point).is_some()).collect()
    }

    /// All points of a light, each counted into a bit of its own.
    fn count_points(&mut self, points: &[usize]) -> Vec<Round> {
        let rects: Vec<_> = points.iter().filter_map(|&light| self.light_rect(light).map(|rect| (light, rect))).collect();
        let scissor = rects.iter().map(|(_, rect)| *rect).reduce(around).unwrap_or_else(|| self.whole());
        let row = techniques::row(self.settings.technique);
        let mut volumes = std::mem::take(&mut self.plan.volumes);
        let counted = {
            let points: Vec<_> = rects
                .into_iter()
                .filter_map(|(light, rect)| Some(own_bits::Point { light, rect, casters: self.casters(light, scissor)? }))
                .collect();
            let ask = counting::Ask {
                budget: self.plan.budget.without_bounds(),
                solid: None,
                values: false,
                ..self.ask(points[0].light, scissor)
            };
            own_bits::count_points(row, &points, &ask, &mut volumes)
        };
        self.plan.volumes = volumes;
        let (rounds, words) = counted;
        self.plan.notes.push(words);
        let budgets = rounds.iter().flat_map(|round| &round.lights).filter_map(|shining| shining.budget);
        self.plan.budget.points_mask |= budgets.fold(0, |mask, budget| mask | budget.verdict_mask);
        rounds
    }

    /// The count of the light, or point, that is looked at; with points that have a bit each, of all that share the
    /// stencil with it.
    pub(super) fn count_shown(&mut self, light: usize) -> Counted {
        let points = self.points_with_bits(light);
        let looks = |round: &Round| round.lights.iter().find(|shining| shining.light == light).and_then(|shining| shining.budget);
        let rounds = if points.is_empty() { Vec::new() } else { self.count_points(&points) };
        for round in rounds {
            if let Some(budget) = looks(&round) {
                let points_mask = round.lights.iter().filter_map(|shining| shining.budget);
                let points_mask = points_mask.fold(0, |mask, budget| mask | budget.verdict_mask);
                let Round { base, steps, .. } = round;
                return Counted { count: LightCount { base, steps, budget, notes: Vec::new() }, points_mask };
            }
        }
        Counted { count: self.count(light), points_mask: 0 }
    }

    /// The frame begins.
    pub(super) fn start(&mut self, stencil: u8) {
        self.clear_all([0.0; 4], stencil);
        (self.stored, self.used) = (stencil, 0);
    }

    /// Counting begins anew where anything was counted or marked, or begins from elsewhere.
    pub(super) fn start_round(&mut self, round: &Round) {
        let light = round.lights.first();
        let shares = light.is_some_and(|shining| shining.budget.is_none());
        if shares {
            return;
        }
        if self.used != 0 || self.stored != round.base {
            self.reset_stencil(light.map(|shining| shining.light), round.base);
        }
        self.used = u8::MAX;
    }

    /// For what is added without having been counted: once to each pixel, marked in a bit that nobody used since the stencil
    /// was cleared.
    pub(super) fn unused_bit(&mut self, light: Option<usize>) -> StencilState {
        let BitBudget { beyond_mask, mirror_mask, receiver_mask, .. } = self.plan.budget;
        let taken = beyond_mask | mirror_mask | receiver_mask;
        let free = |frame: &Self| !(frame.used | frame.stored | taken);
        if free(self) == 0 {
            self.reset_stencil(light, 0);
        }
        let bit = free(self) & free(self).wrapping_neg();
        self.used |= bit;
        self.plan.budget.points_mask |= bit;
        StencilState::light_once(BitBudget::of_point(0, bit))
    }

    fn reset_stencil(&mut self, light: Option<usize>, value: u8) {
        (self.stored, self.used) = (value, 0);
        let why = "Each light counts anew, from how many of its volumes hold the eye.";
        let whose = light.map_or_else(String::new, |light| format!("light {light}: "));
        self.reset_view(&format!("{whose}reset the count"), why, value);
    }
}
