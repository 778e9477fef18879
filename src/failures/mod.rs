//! The failure gallery: each classic mistake of shadow volumes, made by one switch
//! ([`crate::settings::Settings::failure`]).
//!
//! Nearly all of what is written about shadow volumes is about what goes wrong with them; here it can be
//! looked at, beside the picture that is right. [`TABLE`] has a row for each failure: what is seen, why,
//! what cures it, which paper says so, and a scene and view that show it well. Any other scene may be
//! spoiled the same way.
//!
//! ```text
//!   settings --while_on--> settings' --plan--> FramePlan --spoil--> FramePlan'  (validated, drawn)
//!              technique                                  states, parts, flaws
//! ```
//!
//! A failure names the technique that it is a failure of, and counts by it while it is on. The rest is a
//! pure change of the finished plan, in `spoil.rs`: parts of volumes left out, operations or states
//! exchanged, volumes told to build themselves wrongly ([`crate::geometry::Flaw`]). The director knows
//! nothing of it, and [`crate::frame::validate`] checks the spoiled plan like any other, but for the one
//! rule that is broken by intention ([`crate::frame::FramePlan::breaks`]).

mod rows;
mod spoil;

use std::borrow::Cow;

use crate::frame::FramePlan;
use crate::scene::AnimationChoice;
use crate::settings::{Counting, Culling, Failure, Overflow, SceneChoice, Settings, Show, Technique};

pub use rows::TABLE;

/// One failure, for people and for the director.
pub struct Row {
    /// Which.
    pub failure: Failure,
    /// A few words.
    pub title: &'static str,
    /// What is seen: one sentence.
    pub seen: &'static str,
    /// Why: one sentence.
    pub why: &'static str,
    /// What cures it: one sentence.
    pub cure: &'static str,
    /// Paper and section.
    pub source: &'static str,
    /// What counts while the failure is on.
    pub technique: Technique,
    /// The stock scene that shows it well.
    pub scene: &'static str,
    /// The rest of the demonstration: camera, lights, time.
    view: fn(&mut Settings),
    /// Spoils a finished plan.
    spoil: fn(&mut FramePlan),
}

/// The row of a failure.
#[must_use]
pub fn row(failure: Failure) -> &'static Row {
    // The table is in the order of `Failure::ALL`; a test holds it so.
    &TABLE[Failure::ALL.iter().position(|one| *one == failure).unwrap_or(0)]
}

/// Settings that show a failure well: its own scene, camera, lights and time, standing still, counted by
/// the default technique when the failure is switched off; size, samples, device and shaders are
/// `base`'s.
#[must_use]
pub fn demonstration(failure: Failure, base: &Settings) -> Settings {
    let row = row(failure);
    let mut settings = Settings {
        scene: SceneChoice::Stock(row.scene.into()),
        failure: Some(failure),
        show: Show::Final,
        animation: Some(AnimationChoice::Still),
        size: base.size,
        samples: base.samples,
        smooth_terminator: base.smooth_terminator,
        adapter: base.adapter.clone(),
        shaders: base.shaders.clone(),
        ..Settings::default()
    };
    (row.view)(&mut settings);
    settings
}

/// The settings that are planned: the failure's technique stands in for the chosen one, and counts that
/// overflow do so, for nobody who made these mistakes counted in batches.
#[must_use]
pub fn while_on(settings: &Settings) -> Cow<'_, Settings> {
    match settings.failure {
        Some(failure) => Cow::Owned(Settings {
            technique: row(failure).technique,
            // What is wrong on purpose is not left out for meeting nothing.
            culling: Culling { on: false, depth_bounds: false, ..settings.culling },
            counting: Counting { overflow: Overflow::Naive, ..settings.counting },
            ..settings.clone()
        }),
        None => Cow::Borrowed(settings),
    }
}

/// Spoils a finished plan, and notes so in it.
pub fn spoil(failure: Failure, plan: &mut FramePlan) {
    let row = row(failure);
    (row.spoil)(plan);
    plan.notes.push(format!("wrong on purpose ({}, counted by {}): {}", failure.name(), row.technique.name(), row.seen));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::stock;

    #[test]
    fn the_table_lists_every_failure_once_in_order() {
        let listed: Vec<_> = TABLE.iter().map(|row| row.failure).collect();
        assert_eq!(listed, Failure::ALL);
        for failure in Failure::ALL {
            assert_eq!(row(failure).failure, failure);
        }
    }

    #[test]
    fn every_row_says_one_sentence_of_each_kind() {
        for row in &TABLE {
            for words in [row.seen, row.why, row.cure] {
                assert!(words.ends_with('.') && !words.contains(". "), "{}: {words}", row.title);
            }
            assert!(stock::find(row.scene).is_some(), "{}", row.scene);
        }
    }

    #[test]
    fn a_demonstration_keeps_what_is_not_of_the_scene() {
        let base = Settings { size: [64, 36], samples: 4, technique: Technique::None, floor: true, ..Settings::default() };
        for failure in Failure::ALL {
            let shown = demonstration(failure, &base);
            assert_eq!((shown.size, shown.samples, shown.floor), ([64, 36], 4, false));
            assert_eq!((shown.failure, shown.technique), (Some(failure), Technique::default()));
            assert_eq!(while_on(&shown).technique, row(failure).technique);
            assert_eq!(while_on(&Settings { failure: None, ..shown.clone() }).technique, Technique::default());
        }
    }
}
