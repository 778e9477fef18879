//! The paper that diagrams are drawn on: from places of the plane to pixels.

use glam::{DMat4, DVec2};

use super::rays::Ray;
use super::section::{Piece, Plane, Section};
use super::{Scope, color, middle_of, with_alpha};
use crate::frame::{Camera, Label, LabelKind, Stroke};
use crate::techniques::bounds::dot;

/// What is cut open.
const SOLID: [f32; 3] = [0.30, 0.32, 0.37];

/// A surface in the light, and one in shadow.
const LIT: [f32; 4] = [1.0, 0.93, 0.66, 1.0];
const DARK: [f32; 4] = [0.50, 0.40, 0.78, 1.0];

/// A character's width to the height of the letters.
const ADVANCE: f32 = 0.602;

/// Lines, areas and words in the making.
#[derive(Debug)]
pub struct Sheet<'a> {
    plane: Plane,
    side: &'a Camera,
    clip_from_world: DMat4,
    size: DVec2,
    /// The height of letters, pixels: what everything else is measured in.
    text: f32,
    strokes: Vec<Stroke>,
    labels: Vec<Label>,
}

#[expect(clippy::cast_precision_loss, reason = "pixels, and a few letters")]
#[expect(clippy::cast_possible_truncation, reason = "pixels")]
impl<'a> Sheet<'a> {
    /// An empty one over what `side` sees of the plane.
    #[must_use]
    pub fn new(plane: Plane, side: &'a Camera, size: [u32; 2]) -> Self {
        let text = (size[1] as f32 / 36.0).round().clamp(8.0, 34.0);
        let size = DVec2::new(size[0].into(), size[1].into());
        let clip_from_world = side.clip_from_world();
        Self { plane, side, clip_from_world, size, text, strokes: Vec::new(), labels: Vec::new() }
    }

    /// What was drawn: lines and areas, and words.
    #[must_use]
    pub fn finished(self) -> (Vec<Stroke>, Vec<Label>) {
        (self.strokes, self.labels)
    }

    /// A place's pixel.
    fn at(&self, place: DVec2) -> [f32; 2] {
        let clip = self.clip_from_world * self.plane.world(place).extend(1.0);
        ((DVec2::new(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * self.size).as_vec2().to_array()
    }

    /// The lower left and the upper right of the picture, on the plane.
    fn corners(&self) -> [DVec2; 2] {
        let middle = self.plane.place(self.side.eye);
        let half = DVec2::new(self.side.aspect, 1.0) * ((self.side.vertical_fov / 2.0).tan() * middle.z.abs());
        [middle.truncate() - half, middle.truncate() + half]
    }

    /// Metres along a way to where it leaves the picture.
    pub fn way_out(&self, from: DVec2, way: DVec2) -> f64 {
        let [low, high] = self.corners();
        let axis = |axis: usize| {
            let bound = if way[axis] > 0.0 { high[axis] } else { low[axis] };
            if way[axis] == 0.0 { f64::INFINITY } else { (bound - from[axis]) / way[axis] }
        };
        axis(0).min(axis(1)).max(0.0)
    }

    /// A line.
    pub fn line(&mut self, from: DVec2, to: DVec2, width: f32, color: [f32; 4]) {
        let points = vec![self.at(from), self.at(to)];
        let width = width * self.text / 10.0;
        self.strokes.push(Stroke { points, closed: false, width, color, fill: None });
    }

    /// A broken line.
    pub fn dashes(&mut self, from: DVec2, to: DVec2, width: f32, color: [f32; 4]) {
        let [low, high] = self.corners();
        let dash = (high.y - low.y) / self.size.y * f64::from(self.text) * 0.55;
        let length = from.distance(to).min((high - low).length());
        let way = (to - from).normalize_or_zero();
        let count = (length / (2.0 * dash)).ceil() as usize;
        for number in 0..count {
            let begin = number as f64 * 2.0 * dash;
            self.line(from + way * begin, from + way * (begin + dash).min(length), width, color);
        }
    }

    /// A convex area.
    pub fn area(&mut self, corners: &[DVec2], fill: [f32; 4]) {
        let points = corners.iter().map(|corner| self.at(*corner)).collect();
        self.strokes.push(Stroke { points, closed: true, width: 0.0, color: fill, fill: Some(fill) });
    }

    /// A dot; the plainest has the size 1.
    pub fn dot(&mut self, place: DVec2, scale: f32, color: [f32; 3]) {
        let radius = self.text * 0.27 * scale;
        self.strokes.push(dot(self.at(place), radius, color));
    }

    /// Words beside a place, so many letters' heights to the right and down.
    pub fn note(&mut self, place: DVec2, [right, down]: [f32; 2], words: &str) {
        let [x, y] = self.at(place);
        let middle = [x + right * self.text, y + down * self.text];
        let size = [(words.chars().count() as f32 * ADVANCE + 0.7) * self.text, self.text * 1.35];
        let [width, height] = self.size.as_vec2().to_array();
        // Into the picture, where there is room; nothing is said of what is far outside.
        if !(-width..2.0 * width).contains(&x) || !(-height..2.0 * height).contains(&y) {
            return;
        }
        let left = (middle[0] - size[0] / 2.0).clamp(2.0, (width - size[0] - 2.0).max(2.0)).round();
        let top = (middle[1] - size[1] / 2.0).clamp(2.0, (height - size[1] - 2.0).max(2.0)).round();
        let plate = [left, top, size[0].round(), size[1].round()];
        self.labels.push(Label { text: words.into(), kind: LabelKind::Note, anchor: [x, y], plate, text_size: self.text });
    }

    /// A line of words along the lower edge.
    pub fn caption(&mut self, words: &str) {
        let width = (words.chars().count() as f32 * ADVANCE + 0.8) * self.text;
        let height = self.text * 1.5;
        let [across, down] = self.size.as_vec2().to_array();
        let plate = [((across - width) / 2.0).max(0.0).round(), down - height - self.text * 0.5, width, height];
        let anchor = [plate[0], plate[1]];
        self.labels.push(Label { text: words.into(), kind: LabelKind::Note, anchor, plate, text_size: self.text });
    }

    /// What the colours of so many volumes mean, in the lower left.
    pub fn legend(&mut self, entries: &[(u32, &str)]) {
        let (text, height) = (self.text, self.size.y as f32);
        let (mut left, top) = (text, height - text * 1.9);
        for (count, words) in entries {
            let [r, g, b] = color(*count);
            let corners = [[0.0, 0.15], [1.4, 0.15], [1.4, 0.95], [0.0, 0.95]];
            let points = corners.map(|[x, y]| [left + x * text, top + y * text]).to_vec();
            let fill = [r, g, b, 1.0];
            self.strokes.push(Stroke { points, closed: true, width: 0.0, color: fill, fill: Some(fill) });
            left += text * 1.9;
            let width = words.chars().count() as f32 * ADVANCE * text;
            let plate = [left, top - text * 0.1, width, text * 1.3];
            let anchor = [left, top];
            let label = Label { text: (*words).into(), kind: LabelKind::Legend, anchor, plate, text_size: text };
            self.labels.push(label);
            left += width + text * 1.4;
        }
    }

    /// Column by column, a pixel wide: what `spans` says of it, each from one height to another in a colour.
    fn columns(&mut self, mut spans: impl FnMut(&Self, f64) -> Vec<(f64, f64, [f32; 4])>) {
        let [low, high] = self.corners();
        let columns = self.size.x as usize;
        let step = (high.x - low.x) / columns as f64;
        let row = |height: f64| ((high.y - height) / (high.y - low.y) * self.size.y) as f32;
        let mut strokes = Vec::new();
        for column in 0..columns {
            let (x, middle) = (column as f32, low.x + (column as f64 + 0.5) * step);
            for (from, to, fill) in spans(self, middle) {
                let (top, bottom) = (row(to.min(high.y)), row(from.max(low.y)));
                if bottom > top {
                    let points = vec![[x, top], [x + 1.0, top], [x + 1.0, bottom], [x, bottom]];
                    strokes.push(Stroke { points, closed: true, width: 0.0, color: fill, fill: Some(fill) });
                }
            }
        }
        self.strokes.extend(strokes);
    }

    /// What the volumes hold, in the colours of how many do.
    pub fn shadows(&mut self, section: &Section, alpha: f32) {
        let [low, high] = self.corners();
        self.columns(|_, ahead| {
            let mut from = low.y;
            let legs = section.legs(DVec2::new(ahead, low.y), DVec2::Y, high.y - low.y);
            let mut spans = Vec::new();
            for (to, count) in legs {
                let to = low.y + to;
                if count > 0 {
                    spans.push((from, to, with_alpha(color(count), alpha)));
                }
                from = to;
            }
            spans
        });
    }

    /// What a count says of each place, in the same colours.
    pub fn areas(&mut self, count: impl Fn(DVec2) -> u32) {
        let [low, high] = self.corners();
        let rows = (self.size.y / 2.0).ceil() as usize;
        let step = (high.y - low.y) / rows as f64;
        self.columns(|_, ahead| {
            let at = |height: f64| count(DVec2::new(ahead, height));
            let mut spans: Vec<(f64, f64, [f32; 4])> = Vec::new();
            let (mut from, mut here) = (low.y, at(low.y));
            for number in 1..=rows {
                let height = low.y + number as f64 * step;
                let beyond = at(height);
                if beyond != here || number == rows {
                    // Where it changes, to a fraction of a pixel.
                    let (mut below, mut above) = (height - step, height);
                    for _ in 0..if beyond == here { 0 } else { 6 } {
                        let middle = (below + above) / 2.0;
                        *if at(middle) == here { &mut below } else { &mut above } = middle;
                    }
                    if here > 0 {
                        spans.push((from, above, with_alpha(color(here), 0.42)));
                    }
                    (from, here) = (above, beyond);
                }
            }
            spans
        });
    }

    /// What is cut open.
    pub fn solids(&mut self, section: &Section) {
        self.columns(|_, ahead| {
            section.solid(ahead).into_iter().map(|(_, from, to)| (from, to, with_alpha(SOLID, 1.0))).collect()
        });
    }

    /// The same, each instance in a colour of its own; and its outline.
    pub fn solids_in(&mut self, section: &Section, of: impl Fn(usize) -> Option<[f32; 3]>) {
        self.columns(|_, ahead| {
            let spans = section.solid(ahead).into_iter();
            spans.map(|(instance, from, to)| (from, to, with_alpha(of(instance).unwrap_or(SOLID), 1.0))).collect()
        });
        self.outline_in(section, |piece| match of(piece.instance) {
            Some(color) => (with_alpha(color, 1.0), 2.4),
            None => ([0.72, 0.74, 0.78, 1.0], 1.4),
        });
    }

    /// Surfaces, each piece as `of` says: its colour and its width.
    pub fn outline_in(&mut self, section: &Section, of: impl Fn(&Piece) -> ([f32; 4], f32)) {
        for piece in &section.pieces {
            let (color, width) = of(piece);
            self.line(piece.from, piece.to, width, color);
        }
    }

    /// Surfaces, light and dark as the light leaves them.
    pub fn outline(&mut self, section: &Section) {
        for (piece, from, to, lit) in verdicts(section) {
            let _ = piece;
            self.line(from, to, 2.2, if lit { LIT } else { DARK });
        }
    }

    /// The names of solids, where they are cut and there is room.
    pub fn names(&mut self, scope: &Scope<'_>, section: &Section) {
        for (instance, (_, node, _)) in scope.scene.instances().enumerate() {
            let [low, high] = self.corners();
            let letter = f64::from(self.text) * (high.y - low.y) / self.size.y;
            let of_it = section.pieces.iter().filter(|piece| piece.instance == instance);
            let large = of_it.map(|piece| piece.from.distance(piece.to)).sum::<f64>() > 8.0 * letter;
            let middle = middle_of(section, instance);
            if large && section.solid(middle.x).iter().any(|span| span.0 == instance) {
                self.note(middle, [0.0, 0.0], &node.name);
            }
        }
    }

    /// "Lit" and "in shadow" beside what is both: of the solid thing that has the longest piece of each.
    pub fn verdicts(&mut self, section: &Section) {
        let all = verdicts(section);
        let closed = |instance: usize| section.solid(middle_of(section, instance).x).iter().any(|span| span.0 == instance);
        let mut best: Option<(f64, [DVec2; 2])> = None;
        let mut instances: Vec<_> = all.iter().map(|(piece, ..)| piece.instance).collect();
        instances.dedup();
        for instance in instances.into_iter().filter(|instance| closed(*instance)) {
            let middle = middle_of(section, instance);
            // Where it faces the light, for what is turned away from it is dark without any volume.
            let sum = |wanted: bool| {
                let pieces =
                    all.iter().filter(|(piece, _, _, lit)| piece.instance == instance && piece.faces_light && *lit == wanted);
                pieces.fold((0.0, DVec2::ZERO), |(length, place), (_, from, to, _)| {
                    let more = from.distance(*to);
                    (length + more, place + (*from + *to) / 2.0 * more)
                })
            };
            let (lit, dark) = (sum(true), sum(false));
            let least = lit.0.min(dark.0);
            if least > 0.0 && best.is_none_or(|(length, _)| least > length) {
                let [lit, dark] = [lit.1 / lit.0, dark.1 / dark.0].map(|place| middle + (place - middle) * 1.25);
                best = Some((least, [lit, dark]));
            }
        }
        if let Some((_, [lit, dark])) = best {
            let side = if dark.x > lit.x { 1.0 } else { -1.0 };
            self.note(lit, [-side * 1.6, 0.0], "lit");
            self.note(dark, [side * 3.2, -0.6], "in shadow");
        }
    }

    /// "Shadow volume" where there is most room in one.
    pub fn shadow_words(&mut self, section: &Section) {
        let [low, high] = self.corners();
        let mut most: Option<(f64, DVec2)> = None;
        for step in 4..36 {
            let ahead = low.x + (high.x - low.x) * f64::from(step) / 40.0;
            let mut from = low.y;
            for (to, count) in section.legs(DVec2::new(ahead, low.y), DVec2::Y, high.y - low.y) {
                let to = low.y + to;
                let middle = DVec2::new(ahead, (from + to) / 2.0);
                let nearest = section.pieces.iter().map(|piece| middle.distance((piece.from + piece.to) / 2.0));
                let room = nearest.fold((to - from) / 2.0, f64::min);
                if count > 0 && most.is_none_or(|(least, _)| room > least) {
                    most = Some((room, middle));
                }
                from = to;
            }
        }
        if let Some((_, place)) = most {
            self.note(place, [0.0, 0.0], "shadow volume");
        }
    }

    /// What is cut before a mirror where it seems to stand behind it, faintly.
    pub fn reflected(&mut self, section: &Section, panes: &[Piece]) {
        let Some(pane) = panes.first() else { return };
        let normal = pane.out.normalize_or(DVec2::Y);
        let height = |place: DVec2| normal.dot(place - pane.from);
        let image = |place: DVec2| place - normal * (2.0 * height(place));
        for piece in section.pieces.iter().filter(|piece| !piece.mirror && height(piece.from).min(height(piece.to)) > 0.0) {
            let solid = section.solid((piece.from.x + piece.to.x) / 2.0);
            if solid.iter().any(|span| span.0 == piece.instance) {
                self.line(image(piece.from), image(piece.to), 1.2, [0.42, 0.84, 0.95, 0.5]);
            }
        }
    }

    /// A ray of the eye, each piece in the colour of its count, with the count at its middle; that of the first piece at
    /// such a share of it.
    pub fn ray(&mut self, ray: &Ray, first: f64) {
        let mut from = 0.0;
        for (number, &(to, count)) in ray.legs.iter().enumerate() {
            let (begin, end) = (ray.way * from, ray.way * to);
            self.line(begin, end, 2.0, with_alpha(color(count), 1.0));
            if number + 1 < ray.legs.len() || ray.hits {
                self.dot(end, 0.9, color(ray.legs.get(number + 1).map_or(count, |next| next.1)));
            }
            let shown = to.min(self.way_out(DVec2::ZERO, ray.way));
            let pixels = (shown - from) / (self.corners()[1].y - self.corners()[0].y) * self.size.y;
            if pixels > f64::from(self.text) * 1.9 {
                let share = if number == 0 { first } else { 0.5 };
                self.note(ray.way * (from + (shown - from) * share), [0.0, 0.0], &count.to_string());
            }
            from = to;
        }
    }
}

/// Every surface in pieces that are wholly lit or wholly not.
fn verdicts(section: &Section) -> Vec<(&Piece, DVec2, DVec2, bool)> {
    let mut all = Vec::new();
    for piece in &section.pieces {
        let along = piece.to - piece.from;
        // A hair before the surface: what it shadows itself begins there.
        let before = piece.from + piece.out.normalize_or_zero() * (along.length() * 1e-3).clamp(1e-6, 1e-4);
        let mut from = 0.0;
        for (to, count) in section.legs(before, along, 1.0) {
            all.push((piece, piece.from + along * from, piece.from + along * to, count == 0 && piece.faces_light));
            from = to;
        }
    }
    all
}
