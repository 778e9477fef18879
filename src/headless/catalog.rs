//! `obscura list`: what there is to choose from.

use std::fmt;

use serde::Serialize;

use crate::failures;
use crate::scene::stock;
use crate::settings::{Show, Technique};
use crate::techniques;

/// Scenes, techniques and shows.
#[derive(Debug, Clone, Serialize)]
pub struct Catalog {
    /// The stock scenes.
    pub scenes: Vec<Entry>,
    /// The techniques.
    pub techniques: Vec<TechniqueEntry>,
    /// What can be shown.
    pub shows: Vec<Entry>,
    /// The failure gallery.
    pub failures: Vec<FailureEntry>,
}

/// A failure, in a sentence each.
#[derive(Debug, Clone, Serialize)]
pub struct FailureEntry {
    /// As the command line takes it.
    pub name: &'static str,
    /// A few words.
    pub title: &'static str,
    /// What is seen.
    pub seen: &'static str,
    /// Why.
    pub why: &'static str,
    /// What cures it.
    pub cure: &'static str,
    /// Paper and section.
    pub source: &'static str,
    /// The scene it is shown on.
    pub scene: &'static str,
}

/// A name, and what it stands for.
#[derive(Debug, Clone, Serialize)]
pub struct Entry {
    /// As the command line takes it.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
}

/// A technique, and where it comes from.
#[derive(Debug, Clone, Serialize)]
pub struct TechniqueEntry {
    /// As the command line takes it.
    pub name: &'static str,
    /// One sentence.
    pub about: &'static str,
    /// True where every pixel is right on every scene.
    pub exact: bool,
    /// Paper and section.
    pub source: &'static str,
}

impl Catalog {
    /// Everything this program has.
    #[must_use]
    pub fn new() -> Self {
        Self {
            scenes: stock::TABLE.iter().map(|scene| Entry { name: scene.name, about: scene.about }).collect(),
            techniques: Technique::ALL
                .map(|technique| {
                    let row = techniques::row(technique);
                    TechniqueEntry { name: technique.name(), about: row.about, exact: row.exact, source: row.source }
                })
                .into(),
            shows: Show::ALL.map(|show| Entry { name: show.name(), about: show.about() }).into(),
            failures: failures::TABLE
                .iter()
                .map(|&failures::Row { failure, title, seen, why, cure, source, scene, .. }| FailureEntry {
                    name: failure.name(),
                    title,
                    seen,
                    why,
                    cure,
                    source,
                    scene,
                })
                .collect(),
        }
    }
}

impl Default for Catalog {
    fn default() -> Self {
        Self::new()
    }
}

impl fmt::Display for Catalog {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "scenes")?;
        for Entry { name, about } in &self.scenes {
            writeln!(f, "  {name:<14} {about}")?;
        }
        writeln!(f, "\ntechniques (--technique)")?;
        for TechniqueEntry { name, about, exact, source } in &self.techniques {
            let exact = if *exact { "exact" } else { "not exact" };
            writeln!(f, "  {name:<14} {about} ({exact}; {source})")?;
        }
        writeln!(f, "\nshows (--show)")?;
        for Entry { name, about } in &self.shows {
            writeln!(f, "  {name:<14} {about}")?;
        }
        writeln!(f, "\nfailures (--failure), made on purpose")?;
        for FailureEntry { name, title, seen, why, cure, source, scene } in &self.failures {
            writeln!(f, "  {name:<22} {title} (shown on {scene}; {source})")?;
            for (word, sentence) in [("seen", seen), ("why", why), ("cure", cure)] {
                writeln!(f, "  {:<22} {word}: {sentence}", "")?;
            }
        }
        Ok(())
    }
}
