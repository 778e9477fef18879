//! What [`super::verify`] found: kept as data for `--json`, and told as a table.

use std::collections::BTreeMap;
use std::fmt::{self, Display};

use serde::Serialize;

use super::verify::{Judged, Verified, whole};
use super::wander::Place;
use crate::cli::render_command;
use crate::scene::Scene;
use crate::settings::{PlanarMode, Settings, Show, Technique};
use crate::techniques::{self, planar};
use crate::truth::WrongPixel;

/// What was found.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// The scene's name.
    pub scene: String,
    /// Of each picture, pixels.
    pub size: [u32; 2],
    /// How many views were looked at.
    pub views: usize,
    /// What random views were made from.
    pub seed: Option<u64>,
    /// Where the eyes of random views were.
    pub eyes: BTreeMap<Place, usize>,
    /// How many of the views have their eye in a shadow of their light.
    pub eyes_in_shadow: usize,
    /// Why no technique claims to be exact, where none does.
    pub spoiled_by: Option<&'static str>,
    /// The device.
    pub adapter: String,
    /// Technique by technique and light by light, all views together.
    pub lights: Vec<LightRow>,
    /// Which surface each pixel shows, through which mirrors: all views together.
    pub surfaces: SurfaceRow,
    /// The first views with wrong pixels, exact techniques' before others'.
    pub wrong_views: Vec<WrongView>,
    /// The first views that show a wrong surface.
    pub wrong_surfaces: Vec<WrongSurfaceView>,
    /// Milliseconds spent on drawing.
    pub draw_ms: f64,
    /// Milliseconds spent on rays.
    pub trace_ms: f64,
}

/// One technique and one light.
#[derive(Debug, Clone, Serialize)]
pub struct LightRow {
    /// The technique.
    pub technique: Technique,
    /// What draws shadows in its place: the verdict is then one on receivers alone.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub planar: Option<PlanarMode>,
    /// Whether it claims to be exact, with these settings.
    pub exact: bool,
    /// The light's index.
    pub light: usize,
    /// Its name.
    pub name: String,
    /// Views that looked at it.
    pub views: usize,
    /// Pixels that rays agree on.
    pub decided: usize,
    /// Of those, lit.
    pub lit: usize,
    /// Of those, in shadow.
    pub shadow: usize,
    /// Pixels that rays do not agree on.
    pub edges: usize,
    /// Decided pixels that are drawn otherwise.
    pub wrong: usize,
}

/// What pixels show, whatever lights it.
#[derive(Debug, Clone, Default, Serialize)]
pub struct SurfaceRow {
    /// Whether every decided pixel must be right, with these settings.
    pub exact: bool,
    /// Pixels that rays agree on.
    pub decided: usize,
    /// Of those, how many are seen after so many reflections: the first entry is for none.
    pub bounces: Vec<usize>,
    /// Pixels that rays do not agree on.
    pub edges: usize,
    /// Decided pixels that show another surface, or show it through other mirrors.
    pub wrong: usize,
}

/// A view that shows a wrong surface.
#[derive(Debug, Clone, Serialize)]
pub struct WrongSurfaceView {
    /// How many pixels do.
    pub wrong: usize,
    /// The first of them, from the left and the top.
    pub first: [u32; 2],
    /// What is seen there, and through which mirrors.
    pub seen: String,
    /// What is drawn there.
    pub drawn: String,
    /// What draws it.
    pub command: String,
}

/// A view with wrong pixels.
#[derive(Debug, Clone, Serialize)]
pub struct WrongView {
    /// The technique.
    pub technique: Technique,
    /// What draws shadows in its place.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub planar: Option<PlanarMode>,
    /// Whether it claims to be exact.
    pub exact: bool,
    /// The light.
    pub light: usize,
    /// How many.
    pub wrong: usize,
    /// The first of them.
    pub first: WrongPixel,
    /// What draws them.
    pub command: String,
}

/// For so many views with wrong pixels, of exact techniques and of others, the command is kept.
pub(super) const WRONG_VIEWS_KEPT: usize = 8;

impl Report {
    /// Wrong pixels of techniques that claim to have none, and pixels that show a wrong surface.
    #[must_use]
    pub fn broken_promises(&self) -> usize {
        let lights: usize = self.lights.iter().filter(|row| row.exact).map(|row| row.wrong).sum();
        lights + if self.surfaces.exact { self.surfaces.wrong } else { 0 }
    }
}

impl Report {
    pub(super) fn add(
        &mut self,
        view: &Verified,
        scene: &Scene,
        settings: &Settings,
        rows: &mut BTreeMap<(usize, usize), LightRow>,
    ) {
        self.draw_ms += view.draw_ms;
        self.trace_ms += view.trace_ms;
        self.eyes_in_shadow += usize::from(view.judged.eye_in_shadow);
        self.add_surfaces(&view.judged, settings);
        for (technique, light, found) in &view.judged.found {
            let exact = techniques::claims_exact(&Settings { technique: *technique, ..settings.clone() });
            let order = Technique::ALL.iter().position(|one| one == technique).unwrap_or(usize::MAX);
            let row = rows.entry((order, *light)).or_insert_with(|| LightRow {
                technique: *technique,
                planar: planar::is_on(settings).then_some(settings.planar.mode),
                exact,
                light: *light,
                name: scene.light_name(&settings.mirrors, *light),
                views: 0,
                decided: 0,
                lit: 0,
                shadow: 0,
                edges: 0,
                wrong: 0,
            });
            row.views += 1;
            row.decided += found.decided;
            row.lit += found.lit;
            row.shadow += found.shadow;
            row.edges += found.edges;
            row.wrong += found.wrong();
            let kept = self.wrong_views.iter().filter(|view| view.exact == exact).count();
            if let Some(&first) = found.pixels.first()
                && kept < WRONG_VIEWS_KEPT
            {
                let settings = Settings { technique: *technique, show: Show::Shadow, light: *light, ..whole(settings) };
                let command = render_command(&settings);
                self.wrong_views.push(WrongView {
                    technique: *technique,
                    planar: row.planar,
                    exact,
                    light: *light,
                    wrong: found.wrong(),
                    first,
                    command,
                });
            }
        }
    }
}

impl Report {
    fn add_surfaces(&mut self, judged: &Judged, settings: &Settings) {
        let (row, found) = (&mut self.surfaces, &judged.surfaces);
        row.decided += found.decided;
        row.edges += found.edges;
        row.wrong += found.pixels.len();
        row.bounces.resize(row.bounces.len().max(found.bounces.len()), 0);
        row.bounces.iter_mut().zip(&found.bounces).for_each(|(all, these)| *all += these);
        if let (Some(first), Some([seen, drawn])) = (found.pixels.first(), judged.first_wrong.clone())
            && self.wrong_surfaces.len() < WRONG_VIEWS_KEPT
        {
            let command = render_command(&Settings { show: Show::Surfaces, ..whole(settings) });
            let (wrong, first) = (found.pixels.len(), [first.x, first.y]);
            self.wrong_surfaces.push(WrongSurfaceView { wrong, first, seen, drawn, command });
        }
    }
}

impl Display for SurfaceRow {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let promise = if self.exact && self.wrong > 0 { "  must be exact" } else { "" };
        let reflected: usize = self.bounces.iter().skip(1).sum();
        let name = if reflected == 0 { "seen".into() } else { format!("seen, {reflected} in mirrors") };
        writeln!(out, "{:<16} {name:<50} {:>11} {:>9} {:>9}{promise}", "surfaces", self.decided, self.edges, self.wrong)?;
        if reflected == 0 {
            return Ok(());
        }
        let counts: Vec<_> = (1..).zip(&self.bounces[1..]).map(|(bounces, pixels)| format!("{pixels} after {bounces}")).collect();
        writeln!(out, "pixels decided by reflections: {}", counts.join(", "))
    }
}

impl Display for Report {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        match self.seed {
            None => writeln!(out, "{}, {width}x{height}", self.scene)?,
            Some(seed) => writeln!(out, "{}, {} random views of {width}x{height}, seed {seed}", self.scene, self.views)?,
        }
        writeln!(
            out,
            "{:<16} {:<26} {:>11} {:>11} {:>11} {:>9} {:>9}",
            "technique", "light", "lit", "shadow", "decided", "edges", "wrong"
        )?;
        for row in &self.lights {
            let name: String = format!("{} {}", row.light, row.name).chars().take(26).collect();
            let verdict = match (row.exact, row.wrong) {
                (true, 1..) => "  claims to be exact",
                (false, 1..) => "  known to fail",
                (_, 0) => "",
            };
            writeln!(
                out,
                "{:<16} {name:<26} {:>11} {:>11} {:>11} {:>9} {:>9}{verdict}",
                row.planar.map_or(row.technique.name(), PlanarMode::name),
                row.lit,
                row.shadow,
                row.decided,
                row.edges,
                row.wrong
            )?;
        }
        write!(out, "{}", self.surfaces)?;
        if let Some(what) = self.spoiled_by {
            writeln!(out, "no technique claims to be exact here: {what} spoils counting")?;
        }
        if !self.eyes.is_empty() {
            let count = |place| self.eyes.get(&place).copied().unwrap_or(0);
            writeln!(
                out,
                "eyes: {} anywhere, {} in or at casters' boxes, {} behind casters, {} with casters across the near plane, {} at mirrors; {} in shadow",
                count(Place::Anywhere),
                count(Place::AtCaster),
                count(Place::BehindCaster),
                count(Place::AcrossNearPlane),
                count(Place::AtMirror),
                self.eyes_in_shadow
            )?;
        }
        for view in &self.wrong_views {
            let WrongPixel { x, y, .. } = view.first;
            let name = view.planar.map_or(view.technique.name(), PlanarMode::name);
            writeln!(out, "{} wrong by {name}, the first at {x},{y}: {}", view.wrong, view.command)?;
        }
        for view in &self.wrong_surfaces {
            let WrongSurfaceView { wrong, first: [x, y], seen, drawn, command } = view;
            writeln!(out, "{wrong} show a wrong surface, the first at {x},{y}, drawn as {drawn} instead of {seen}: {command}")?;
        }
        writeln!(out, "drawn in {:.1} s, traced in {:.1} s", self.draw_ms / 1e3, self.trace_ms / 1e3)
    }
}
