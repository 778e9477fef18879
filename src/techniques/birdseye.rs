//! The rooms that mirrors make, seen from above (K figure 5): each view's reflected room where it seems to stand, and
//! what the eye sees of it.
//!
//! ```text
//!      reflected room
//!     .  .  .  .  .  .
//!     .   \      /   .       behind the mirror stands the room's reflection; the eye sees into it through the
//!     .    \    /    .       mirror as through a window
//!     +-----\==/-----+
//!     |      \/      |
//!     |      eye     |
//!     +--------------+
//! ```
//!
//! Nothing is bounded here: every room is drawn whole, as far as it lies behind its mirror.

use glam::{DAffine3, DVec2, DVec3, DVec4, Vec2};

use super::above::Above;
use super::bounds::{EYE, Map, Scope, dot};
use crate::frame::plan::View;
use crate::frame::{Camera, Stroke};
use crate::geometry::Sight;
use crate::geometry::clip::hull;
use crate::geometry::planar::height;
use crate::scene::Pose;
use crate::settings::LightBounds;

/// Takes the world to where each view's reflection of it seems to stand.
#[must_use]
pub fn seeming(views: &[View]) -> Vec<DAffine3> {
    let mut all: Vec<DAffine3> = Vec::new();
    for view in views {
        let place = view.through.as_ref().map_or(DAffine3::IDENTITY, |window| all[window.parent] * window.turn.inverse());
        all.push(place);
    }
    all
}

/// What each view sees, outlined in its colour: `views` as planned for the eye, `sights` beside them, in a picture of
/// `size` pixels.
#[must_use]
pub fn strokes(
    (above, eye, pose): (&Above, &Camera, &Pose),
    views: &[View],
    sights: &[Sight],
    color: impl Fn(&[usize]) -> [f32; 3],
    size: [u32; 2],
) -> Vec<Stroke> {
    let bounds = LightBounds::None;
    let scope = Scope { above, eye, size, pose, lights: 0, light: usize::MAX, bounds, scissor: None };
    let map = Map::new(&scope);
    let mut strokes = Vec::new();
    map.frustum(&mut strokes);
    let places = seeming(views);
    for ((view, sight), place) in views.iter().zip(sights).zip(&places) {
        let Some(window) = &view.through else { continue };
        let [r, g, b] = color(&window.path);
        let plane = carried(window.plane, place);
        let mut border = Vec::new();
        for corner in &sight.outline {
            let towards = eye.eye + through_pixel(eye, *corner, size);
            let begins = meets(plane, eye.eye, towards);
            border.extend([begins, Some(map.end(towards))].into_iter().flatten());
        }
        let mut pixels = border.into_iter().filter_map(|place| map.at(place)).map(|pixel| Vec2::from(pixel).as_dvec2()).collect();
        let points: Vec<_> = hull(&mut pixels).into_iter().map(|corner| corner.as_vec2().to_array()).collect();
        if points.len() > 2 {
            let stroke = Stroke { points, closed: true, width: 1.5, color: [r, g, b, 0.9], fill: Some([r, g, b, 0.16]) };
            strokes.push(stroke);
        }
    }
    strokes.extend(map.at(eye.eye).map(|at| dot(at, 5.0, EYE)));
    strokes
}

/// The way from the eye through a place in its picture, pixels from the upper left.
fn through_pixel(eye: &Camera, pixel: DVec2, size: [u32; 2]) -> DVec3 {
    let [left_bottom, right_bottom, _, left_top] = eye.near_rectangle();
    let share = pixel / DVec2::new(size[0].into(), size[1].into());
    left_top + (right_bottom - left_bottom) * share.x + (left_bottom - left_top) * share.y - eye.eye
}

/// A plane where an isometry takes it.
fn carried(plane: DVec4, place: &DAffine3) -> DVec4 {
    let normal = place.transform_vector3(plane.truncate());
    let at = place.transform_point3(plane.truncate() * -plane.w);
    normal.extend(-normal.dot(at))
}

/// Where a ray meets a plane ahead of it.
fn meets(plane: DVec4, from: DVec3, towards: DVec3) -> Option<DVec3> {
    let along = (towards - from).dot(plane.truncate());
    let share = -height(plane, from) / along;
    (share.is_finite() && share > 0.0).then(|| from + (towards - from) * share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::Surface;
    use crate::frame::plan::Window;
    use crate::frame::state::Winding;
    use crate::geometry::planar::reflection;

    #[test]
    fn rooms_stand_behind_their_mirrors() {
        let eye = Camera::look_at(DVec3::ZERO, DVec3::X, 1.0, 1.0, 0.1);
        let Ok(camera) = eye else { unreachable!("a plain camera") };
        let through = |parent, plane: DVec4| View {
            name: String::new(),
            camera,
            winding: Winding::Ccw,
            rect: [0; 4],
            picture: [1, 1],
            texture: None,
            through: Some(Window {
                parent,
                path: vec![0],
                surface: Surface { instance: 0, primitive: 0 },
                exit: Surface { instance: 0, primitive: 0 },
                turn: reflection(plane),
                plane,
                slack: 0.0,
                level: 0,
            }),
        };
        // Two walls that face each other, at x = 2 and x = -1.
        let views = [
            View::of_eye("eye", camera, [1, 1]),
            through(0, DVec4::new(-1.0, 0.0, 0.0, 2.0)),
            through(1, DVec4::new(1.0, 0.0, 0.0, 1.0)),
        ];
        let places = seeming(&views);
        let at = |view: usize| places[view].transform_point3(DVec3::new(0.5, 7.0, 3.0));
        assert_eq!([at(0).x, at(1).x, at(2).x], [0.5, 3.5, 6.5]);
        assert_eq!(
            carried(DVec4::new(1.0, 0.0, 0.0, 1.0), &places[1]),
            DVec4::new(-1.0, 0.0, 0.0, 5.0),
            "it faces back, from x = 5"
        );
        assert_eq!(
            meets(DVec4::new(-1.0, 0.0, 0.0, 5.0), DVec3::ZERO, DVec3::new(1.0, 0.5, 0.0)),
            Some(DVec3::new(5.0, 2.5, 0.0))
        );
        assert_eq!(meets(DVec4::new(-1.0, 0.0, 0.0, 5.0), DVec3::ZERO, DVec3::NEG_X), None, "behind");
    }
}
