//! Every figure of the papers that is drawn here: what the paper shows, what is to be seen in it, and the settings that
//! draw it.
//!
//! [`TABLE`] has a row for each picture, named as the paper names it: a letter for the paper, the figure's number, a letter
//! for the panel; `m-f1` is McGuire's figure 1, his images being numbered apart. The scenes are built from captions and text; where a paper shows somebody's model, one of our own
//! stands for it, and the row says so.

mod rows;

use std::sync::LazyLock;

use crate::settings::{Culling, SceneChoice, Settings};

/// Where a figure is from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Paper {
    /// Improving Shadows and Reflections via the Stencil Buffer.
    Kilgard,
    /// Fast, Practical and Robust Shadows.
    McGuire,
    /// Rendering Shadow Volumes (Game Developer).
    Lengyel,
    /// Stenciled Shadow Volumes in OpenGL.
    Beam,
    /// CSCI 4229, shadow volumes.
    Csci4229,
}

impl Paper {
    /// Every one, in the order people see them.
    pub const ALL: [Self; 5] = [Self::Kilgard, Self::McGuire, Self::Lengyel, Self::Beam, Self::Csci4229];

    /// Author, year and title.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Kilgard => "Kilgard 1999: Improving Shadows and Reflections via the Stencil Buffer",
            Self::McGuire => "McGuire, Hughes, Egan, Kilgard and Everitt 2003: Fast, Practical and Robust Shadows",
            Self::Lengyel => "Lengyel 2002: The Mechanics of Robust Stencil Shadows",
            Self::Beam => "Beam 2004: Stenciled Shadow Volumes in OpenGL",
            Self::Csci4229 => "CSCI 4229: Shadow Volumes",
        }
    }
}

/// One picture.
#[derive(Debug)]
pub struct Figure {
    /// As the command line takes it.
    pub name: &'static str,
    /// Where it is from.
    pub paper: Paper,
    /// What the paper calls it.
    pub number: &'static str,
    /// A few words.
    pub title: &'static str,
    /// What to see in it: one or two sentences.
    pub seen: &'static str,
    /// What of our own stands for what in the paper; empty where nothing needs to.
    pub instead: &'static str,
    /// The stock scene.
    pub scene: &'static str,
    /// The rest of the settings.
    view: fn(&mut Settings),
}

impl PartialEq for Figure {
    /// A name says all.
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// Every figure, paper by paper, in the paper's order.
pub static TABLE: LazyLock<Vec<&'static Figure>> = LazyLock::new(|| rows::TABLES.into_iter().flatten().collect());

/// The figure of that name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Figure> {
    TABLE.iter().copied().find(|figure| figure.name == name)
}

impl Figure {
    /// The settings that draw it; size, samples, device and shaders are `base`'s.
    #[must_use]
    pub fn settings(&self, base: &Settings) -> Settings {
        let mut settings = Settings {
            scene: SceneChoice::Stock(self.scene.into()),
            time: 1.0,
            size: base.size,
            samples: base.samples,
            smooth_terminator: base.smooth_terminator,
            adapter: base.adapter.clone(),
            shaders: base.shaders.clone(),
            // The papers draw volumes whole.
            culling: Culling { clamping: false, ..Culling::default() },
            ..Settings::default()
        };
        (self.view)(&mut settings);
        settings
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test may fail")]
    use super::*;
    use crate::cli::{check, check_against};
    use crate::scene::stock;

    #[test]
    fn names_say_where_a_figure_is_from_and_are_unique() {
        for (at, figure) in TABLE.iter().enumerate() {
            let letter = match figure.paper {
                Paper::Kilgard => 'k',
                Paper::McGuire => 'm',
                Paper::Lengyel => 'l',
                Paper::Beam => 'b',
                Paper::Csci4229 => 'c',
            };
            assert!(figure.name.starts_with(letter), "{}", figure.name);
            assert!(TABLE[..at].iter().all(|before| before.name != figure.name), "{}", figure.name);
            assert!(figure.seen.ends_with('.') && !figure.title.is_empty(), "{}", figure.name);
            assert!(std::ptr::eq(find(figure.name).unwrap(), *figure));
        }
        let papers: Vec<_> = TABLE.iter().map(|figure| Paper::ALL.iter().position(|paper| *paper == figure.paper)).collect();
        assert!(papers.is_sorted(), "paper by paper");
    }

    #[test]
    fn every_figure_can_be_drawn_and_no_two_are_the_same() {
        let base = Settings::default();
        let all: Vec<_> = TABLE.iter().map(|figure| figure.settings(&base)).collect();
        for (at, (figure, settings)) in TABLE.iter().zip(&all).enumerate() {
            check(settings).unwrap();
            check_against(settings, &stock::build(figure.scene).unwrap().unwrap()).unwrap();
            assert!(!all[..at].contains(settings), "{} is drawn twice", figure.name);
        }
    }
}
