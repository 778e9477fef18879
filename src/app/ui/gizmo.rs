//! Lights as icons over the picture, picked and dragged.
//!
//! An icon moves in the plane through the light that faces the camera, or along one world axis:
//! with Shift the axis nearest to the mouse's first move, or the arrow of the chosen light that was grabbed.
//!
//! ```text
//!   mouse ray  e + t d  meets  { p : (p - light) . forward = 0 }      plane
//!   the point of  light + s a  nearest to the mouse ray               axis
//! ```

use egui::{Color32, Pos2, Rect, Stroke, Ui, Vec2, pos2, vec2};
use glam::DVec3;

use super::style;
use super::{Desk, View};
use crate::frame::Camera;
use crate::scene::LightKind;

/// How far from an icon's middle a press still grabs it, points.
const REACH: f32 = 14.0;

/// The length of the chosen light's arrows, points.
const ARROW: f64 = 52.0;

/// The colours of x, y and z.
const AXES: [Color32; 3] =
    [Color32::from_rgb(0xf0, 0x6a, 0x6a), Color32::from_rgb(0x83, 0xd1, 0x6a), Color32::from_rgb(0x6f, 0x9d, 0xf5)];

/// A light on its way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drag {
    /// Which.
    pub light: usize,
    /// Where it was when it was grabbed, metres, world space.
    start: DVec3,
    /// Where the mouse was, points.
    grabbed: Pos2,
    /// The axis it is bound to.
    axis: Option<usize>,
}

/// Where a world point is on the picture; none behind the eye.
#[must_use]
pub fn project(camera: &Camera, picture: Rect, point: DVec3) -> Option<Pos2> {
    let clip = camera.clip_from_world() * point.extend(1.0);
    let at = vec2((clip.x / clip.w) as f32, (-clip.y / clip.w) as f32);
    let at = picture.center() + at * picture.size() * 0.5;
    (clip.w > camera.near.max(1.0e-6) && at.x.is_finite() && at.y.is_finite()).then_some(at)
}

/// The direction from the eye through a point of the picture, its part along `forward` being 1.
pub(super) fn ray(camera: &Camera, picture: Rect, at: Pos2) -> DVec3 {
    let offset = (at - picture.center()) / (picture.size() * 0.5);
    let height = (camera.vertical_fov * 0.5).tan();
    let right = camera.forward.cross(camera.up);
    camera.forward + right * (f64::from(offset.x) * height * camera.aspect) - camera.up * (f64::from(offset.y) * height)
}

impl Drag {
    /// Where the light goes when the mouse is at `mouse`; none where the view gives no answer.
    #[must_use]
    pub fn position(&self, camera: &Camera, picture: Rect, mouse: Pos2) -> Option<DVec3> {
        let depth = (self.start - camera.eye).dot(camera.forward);
        let (from, to) = (ray(camera, picture, self.grabbed), ray(camera, picture, mouse));
        let position = match self.axis {
            // Both rays reach the plane at the light's own depth.
            None => self.start + (to - from) * depth,
            Some(axis) => {
                let axis = unit(axis);
                self.start + axis * (along(camera.eye, to, self.start, axis)? - along(camera.eye, from, self.start, axis)?)
            }
        };
        (position.is_finite() && position.abs().max_element() < 1.0e6).then_some(position)
    }
}

fn unit(axis: usize) -> DVec3 {
    DVec3::AXES[axis.min(2)]
}

/// How far along `axis` from `start` the point nearest to the ray is; none where they run alongside.
fn along(eye: DVec3, direction: DVec3, start: DVec3, axis: DVec3) -> Option<f64> {
    let direction = direction.try_normalize()?;
    let slant = direction.dot(axis);
    let square = 1.0 - slant * slant;
    let between = start - eye;
    (square > 1.0e-4).then(|| (direction.dot(between) * slant - axis.dot(between)) / square)
}

/// The world axis whose picture runs most along `mouse`, for a light at `position`.
fn nearest_axis(camera: &Camera, picture: Rect, position: DVec3, mouse: Vec2) -> usize {
    let alignment = |axis: usize| {
        let step = (position - camera.eye).dot(camera.forward).abs().max(0.01) * 0.01;
        let ends = (project(camera, picture, position), project(camera, picture, position + unit(axis) * step));
        let (Some(from), Some(to)) = ends else { return 0.0 };
        let run = to - from;
        if run.length() > 0.0 { (run.dot(mouse) / run.length()).abs() } else { 0.0 }
    };
    (0..3).max_by(|a, b| alignment(*a).total_cmp(&alignment(*b))).unwrap_or(1)
}

/// One light on the picture.
struct Icon {
    light: usize,
    at: Pos2,
    position: DVec3,
    distance: f64,
}

fn icons(desk: &Desk<'_>, view: &View<'_>, camera: &Camera, picture: Rect) -> Vec<Icon> {
    // What follows after the scene's lights are points of theirs.
    let count = view.scene.map_or(0, |scene| scene.lights.len());
    let lights = view.pose.map_or(&[][..], |pose| &pose.lights);
    let mut icons: Vec<_> = lights
        .iter()
        .enumerate()
        .take(count)
        .filter(|(_, light)| light.kind != LightKind::Directional)
        .filter_map(|(index, light)| {
            let position = desk.settings.lights.get(&index).and_then(|edit| edit.position).unwrap_or(light.center);
            let at = project(camera, picture, position).filter(|at| picture.contains(*at))?;
            Some(Icon { light: index, at, position, distance: position.distance(camera.eye) })
        })
        .collect();
    icons.sort_by(|a, b| b.distance.total_cmp(&a.distance));
    icons
}

/// The arrows of a light at `position`: axis and tip on the picture.
fn arrows(camera: &Camera, picture: Rect, position: DVec3) -> impl Iterator<Item = (usize, Pos2)> {
    let depth = (position - camera.eye).dot(camera.forward);
    let metres = ARROW * 2.0 * depth * (camera.vertical_fov * 0.5).tan() / f64::from(picture.height().max(1.0));
    (0..3).filter_map(move |axis| Some((axis, project(camera, picture, position + unit(axis) * metres)?)))
}

/// What a press at `at` grabs: a light where it is, or where `painted` says that it was on the screen
/// when the mouse went for it.
pub fn grab(
    selected: Option<usize>,
    painted: &[(usize, Pos2)],
    desk: &Desk<'_>,
    view: &View<'_>,
    camera: &Camera,
    picture: Rect,
    at: Pos2,
) -> Option<Drag> {
    if !desk.preferences.icons {
        return None;
    }
    let icons = icons(desk, view, camera, picture);
    let seen = |icon: &Icon| {
        let before = painted.iter().filter(|(light, _)| *light == icon.light).map(|(_, before)| before.distance(at));
        before.fold(icon.at.distance(at), f32::min)
    };
    let icon = icons.iter().filter(|icon| seen(icon) < REACH).min_by(|a, b| seen(a).total_cmp(&seen(b)));
    if let Some(icon) = icon {
        return Some(Drag { light: icon.light, start: icon.position, grabbed: at, axis: None });
    }
    let chosen = icons.iter().find(|icon| Some(icon.light) == selected)?;
    let (axis, _) = arrows(camera, picture, chosen.position).find(|(_, tip)| tip.distance(at) < REACH * 0.8)?;
    Some(Drag { light: chosen.light, start: chosen.position, grabbed: at, axis: Some(axis) })
}

/// The mouse moved: the light follows.
pub fn follow(drag: &mut Drag, desk: &mut Desk<'_>, camera: &Camera, picture: Rect, mouse: Pos2, bound: bool) {
    let moved = mouse - drag.grabbed;
    if bound && drag.axis.is_none() && moved.length() > 6.0 {
        drag.axis = Some(nearest_axis(camera, picture, drag.start, moved));
    }
    if let Some(position) = drag.position(camera, picture, mouse) {
        desk.settings.lights.entry(drag.light).or_default().position = Some(position);
    }
}

/// Draws the icons, and says where each is.
pub fn paint(
    ui: &Ui,
    selected: Option<usize>,
    drag: Option<Drag>,
    desk: &Desk<'_>,
    view: &View<'_>,
    camera: &Camera,
    picture: Rect,
) -> Vec<(usize, Pos2)> {
    let (Some(scene), true) = (view.scene, desk.preferences.icons) else { return Vec::new() };
    let painter = ui.painter_at(picture);
    let mouse = ui.input(|input| input.pointer.hover_pos());
    let icons = icons(desk, view, camera, picture);
    for icon in &icons {
        let Some(light) = scene.lights.get(icon.light) else { continue };
        let edit = desk.settings.lights.get(&icon.light);
        let on = edit.and_then(|edit| edit.on).unwrap_or(true);
        let linear = edit.and_then(|edit| edit.color).unwrap_or(light.color);
        let linear = linear / linear.max_element().max(1.0e-6);
        let color: Color32 = egui::Rgba::from_rgb(linear.x, linear.y, linear.z).into();
        let chosen = selected == Some(icon.light);
        let near = mouse.is_some_and(|mouse| mouse.distance(icon.at) < REACH);
        if chosen {
            for (axis, tip) in arrows(camera, picture, icon.position) {
                let bold = drag.is_some_and(|drag| drag.axis == Some(axis))
                    || mouse.is_some_and(|mouse| mouse.distance(tip) < REACH * 0.8);
                painter.arrow(icon.at, tip - icon.at, Stroke::new(if bold { 3.0 } else { 1.8 }, AXES[axis]));
            }
        }
        let shade = Color32::from_black_alpha(170);
        let radius = if near || chosen { 7.0 } else { 5.5 };
        for ray in 0..8u8 {
            let direction = Vec2::angled(f32::from(ray) * std::f32::consts::TAU / 8.0);
            let line = [icon.at + direction * (radius + 2.5), icon.at + direction * (radius + 6.0)];
            painter.line_segment(line, Stroke::new(3.0, shade));
            if on {
                painter.line_segment(line, Stroke::new(1.5, color));
            }
        }
        painter.circle(icon.at, radius, if on { color } else { style::WELL }, Stroke::new(1.5, if on { shade } else { color }));
        if chosen {
            painter.circle_stroke(icon.at, radius + 9.0, Stroke::new(1.5, style::ACCENT));
        }
        if near || drag.is_some_and(|drag| drag.light == icon.light) {
            let at = pos2(icon.at.x + 18.0, icon.at.y - 16.0);
            let words = format!("{}  {}", icon.light, light.name);
            let galley = painter.layout_no_wrap(words, egui::FontId::proportional(12.0), style::TEXT);
            painter.rect_filled(Rect::from_min_size(at, galley.size()).expand(4.0), 4.0, style::PANEL.gamma_multiply(0.85));
            painter.galley(at, galley, style::TEXT);
        }
    }
    icons.iter().map(|icon| (icon.light, icon.at)).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a failed unwrap is a failed test
    use super::*;

    fn scene() -> (Camera, Rect) {
        let picture = Rect::from_min_size(pos2(300.0, 10.0), vec2(800.0, 500.0));
        (Camera::look_at(DVec3::new(5.0, 4.0, 7.0), DVec3::new(0.0, 1.0, 0.0), 0.9, 1.6, 0.1).unwrap(), picture)
    }

    #[test]
    fn a_point_and_the_ray_through_it_agree() {
        let (camera, picture) = scene();
        let point = DVec3::new(0.7, 2.0, -0.4);
        let at = project(&camera, picture, point).unwrap();
        let direction = ray(&camera, picture, at).normalize();
        assert!(direction.distance((point - camera.eye).normalize()) < 1.0e-6);
        assert_eq!(project(&camera, picture, camera.eye - camera.forward), None, "what lies behind has no place");
    }

    #[test]
    fn a_light_stays_under_the_mouse_at_its_own_depth() {
        let (camera, picture) = scene();
        let start = DVec3::new(0.7, 2.0, -0.4);
        let grabbed = project(&camera, picture, start).unwrap();
        let drag = Drag { light: 0, start, grabbed, axis: None };
        let mouse = grabbed + vec2(60.0, -35.0);
        let moved = drag.position(&camera, picture, mouse).unwrap();
        assert!(project(&camera, picture, moved).unwrap().distance(mouse) < 1.0e-2);
        assert!((moved - start).dot(camera.forward).abs() < 1.0e-9);
    }

    #[test]
    fn an_axis_moves_one_coordinate() {
        let (camera, picture) = scene();
        let start = DVec3::new(0.7, 2.0, -0.4);
        let grabbed = project(&camera, picture, start).unwrap();
        for axis in 0..3 {
            let goal = start + unit(axis) * 0.8;
            let mouse = project(&camera, picture, goal).unwrap();
            let moved = Drag { light: 0, start, grabbed, axis: Some(axis) }.position(&camera, picture, mouse).unwrap();
            assert!(moved.distance(goal) < 1.0e-3, "{moved} {goal}");
            assert_eq!(nearest_axis(&camera, picture, start, mouse - grabbed), axis);
        }
    }

    #[test]
    fn an_axis_that_points_at_the_eye_moves_nothing() {
        let camera = Camera::look_at(DVec3::new(0.0, 0.0, 5.0), DVec3::ZERO, 0.9, 1.6, 0.1).unwrap();
        let (_, picture) = scene();
        let drag = Drag { light: 0, start: DVec3::ZERO, grabbed: picture.center(), axis: Some(2) };
        assert_eq!(drag.position(&camera, picture, picture.center() + vec2(1.0, 0.0)), None);
    }
}
