//! The view from above: its lines are where the projection says, what covers the eye is cut away. And every
//! way to bound a light gives the same pixels.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use common::{Build, Shot, Stage, cube, seen_from};
use glam::{DVec3, Vec3};
use obscura::director::stage;
use obscura::frame::{Camera, Capabilities, DrawSet, FramePlan, Program, Stroke};
use obscura::headless::wander::strays;
use obscura::scene::{LightKind, Scene, stock};
use obscura::settings::{CameraChoice, Culling, LightBounds, LightEdit, Settings, Show, Technique};
use obscura::techniques::bounds::EYE;
use obscura::techniques::cases::Class;
use obscura::techniques::diagram::rays;
use obscura::truth::World;

const SIZE: [u32; 2] = [640, 360];
const LAMP: DVec3 = DVec3::new(6.0, 1.0, -4.0);
const RANGE: f64 = 9.0;

/// A caster in the view, a caster beside it that shades the eye, one beyond the green lamp's range; the eye
/// looks along -z.
fn scene() -> (Scene, Settings) {
    let mut build = Build::new();
    build.floor(-1.0, 30.0);
    let cube = build.mesh(cube(0));
    build.place(cube, DVec3::new(0.0, 0.0, -6.0), DVec3::ONE);
    build.place(cube, DVec3::new(3.0, 0.5, -2.0), DVec3::splat(0.5));
    build.place(cube, DVec3::new(-6.0, 0.0, -4.0), DVec3::ONE);
    let lamp = build.point_light(LAMP);
    build.0.lights[lamp].range = RANGE as f32;
    build.0.lights[lamp].color = Vec3::Y;
    let settings = seen_from(DVec3::ZERO, DVec3::new(0.0, 0.0, -10.0), SIZE);
    (build.0, Settings { show: Show::Bounds, technique: Technique::Auto, ..settings })
}

fn planned(scene: &Scene, settings: &Settings) -> FramePlan {
    stage(settings, scene, &Capabilities::complete()).unwrap().1
}

/// Where the picture from above has a place; none outside.
fn pixel_of(plan: &FramePlan, place: DVec3) -> Option<[f64; 2]> {
    let clip = plan.views[0].camera.clip_from_world() * place.extend(1.0);
    let at = [(clip.x / clip.w * 0.5 + 0.5) * f64::from(SIZE[0]), (0.5 - clip.y / clip.w * 0.5) * f64::from(SIZE[1])];
    let inside = (0..2).all(|axis| (1.0..f64::from(SIZE[axis]) - 1.0).contains(&at[axis]));
    (inside && clip.w > 0.0).then_some(at)
}

fn color(shot: &Shot, at: [f64; 2]) -> [f32; 3] {
    let pixel = shot.image.get_pixel(at[0] as u32, at[1] as u32).0;
    [0, 1, 2].map(|channel| f32::from(pixel[channel]) / 255.0)
}

fn distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    (0..3).map(|channel| (a[channel] - b[channel]).abs()).fold(0.0, f32::max)
}

#[test]
fn the_eyes_frustum_is_where_the_projection_says() {
    let mut stage = Stage::new();
    let (scene, settings) = scene();
    stage.set_scene(&scene);
    let shot = stage.shoot(&settings, &scene);
    let eye = planned(&scene, &Settings { show: Show::Final, ..settings.clone() }).views[0].camera;
    assert_eq!(shot.plan.views[0].camera.forward, DVec3::NEG_Y);
    let mut on_line = 0;
    for corner in eye.near_rectangle() {
        let way = (corner - eye.eye).normalize();
        // Clear of the name, and before the ray leaves the layer of height that is framed.
        for metres in [1.6, 2.0, 2.3, 2.6] {
            let at = pixel_of(&shot.plan, eye.eye + way * metres).unwrap();
            // A line two pixels wide covers the middle of one of the pixels about it, whole; the light's own
            // area lies over it, thinly.
            let about = (-1..=1).flat_map(|x| (-1..=1).map(move |y| [f64::from(x), f64::from(y)]));
            let nearest = about.map(|[x, y]| distance(color(&shot, [at[0] + x, at[1] + y]), EYE)).fold(1.0, f32::min);
            assert!(nearest < 0.05, "{at:?}: {:?}", color(&shot, at));
            // Outside of all four rays: they differ by their height, which the perspective shows.
            let side = way.x.signum() * 20.0;
            let beside = color(&shot, [at[0] + side, at[1]]);
            assert!(distance(beside, EYE) > 0.2, "beside {at:?}: {beside:?}");
            on_line += 1;
        }
    }
    assert_eq!(on_line, 16);
}

#[test]
fn a_lights_range_is_a_circle_of_its_hue() {
    let mut stage = Stage::new();
    let (scene, settings) = scene();
    stage.set_scene(&scene);
    let circle = |range: f64| {
        (0..360).map(move |degree| {
            let (sin, cos) = f64::from(degree).to_radians().sin_cos();
            LAMP + DVec3::new(cos, 0.0, sin) * range
        })
    };
    let green = |[r, g, b]: [f32; 3]| g > 0.97 && r < 0.6 && b < 0.6;
    let count = |shot: &Shot, range: f64| {
        let there: Vec<_> = circle(range).filter_map(|place| pixel_of(&shot.plan, place)).collect();
        (there.iter().filter(|at| green(color(shot, **at))).count(), there.len())
    };
    let shot = stage.shoot(&settings, &scene);
    let (on_circle, there) = count(&shot, RANGE);
    // The eye's lines, the dashes to it and names lie over it here and there.
    assert!(there > 50 && on_circle * 10 > there * 9, "{on_circle} of {there}");
    let (within, there) = count(&shot, RANGE * 0.9);
    assert!(there > 50 && within * 10 < there, "{within} of {there} within");
    // Without an end there is no circle.
    let mut endless = settings;
    endless.lights.insert(0, LightEdit { range: Some(f32::INFINITY), ..LightEdit::default() });
    let shot = stage.shoot(&endless, &scene);
    let (on_circle, there) = count(&shot, RANGE);
    assert!(on_circle * 10 < there, "{on_circle} of {there}");
}

/// The lines over the view from above.
fn strokes(plan: &FramePlan) -> Vec<Stroke> {
    let lines = plan.draws().find_map(|(_, draw)| match &draw.set {
        DrawSet::Strokes(strokes) => Some(strokes.clone()),
        _ => None,
    });
    lines.unwrap()
}

/// Whether a line of two points leads from one pixel to the other, or back.
fn joins(stroke: &Stroke, ends: [[f64; 2]; 2]) -> bool {
    let near = |at, end| distance_of(at, end) < 0.01;
    matches!(stroke.points[..], [a, b] if (near(a, ends[0]) && near(b, ends[1])) || (near(a, ends[1]) && near(b, ends[0])))
}

#[test]
fn what_bounds_the_scissor_is_drawn_as_that_which_was_chosen() {
    let (mut scene, settings) = scene();
    scene.lights[0].range = 1.5;
    let by = |scene: &Scene, light_bounds| {
        let culling = Culling { light_bounds, ..settings.culling };
        planned(scene, &Settings { culling, ..settings.clone() })
    };
    let boxed = by(&scene, LightBounds::Box);
    let corner = |at: usize| LAMP + DVec3::from([1, 2, 4].map(|axis| if at & axis == 0 { -1.5 } else { 1.5 }));
    let mut found = 0;
    for (a, b) in (0..8).flat_map(|a| [1, 2, 4].map(|axis| (a, a | axis))).filter(|(a, b)| a != b) {
        let ends = [a, b].map(|at| pixel_of(&boxed, corner(at)).unwrap());
        assert!(strokes(&boxed).iter().any(|stroke| joins(stroke, ends)), "edge {a} {b}");
        assert!(!strokes(&by(&scene, LightBounds::Sphere)).iter().any(|stroke| joins(stroke, ends)));
        found += 1;
    }
    assert_eq!(found, 12);
    // A spot's cone: lines from the lamp to its rim.
    scene.lights[0].kind = LightKind::Spot { inner: 0.1, outer: 0.5 };
    let coned = by(&scene, LightBounds::Cone);
    let apex = pixel_of(&coned, LAMP).unwrap();
    let from_apex = |plan: &FramePlan| {
        let starts = |stroke: &Stroke| stroke.points.len() == 2 && distance_of(stroke.points[0], apex) < 0.01;
        strokes(plan).iter().filter(|stroke| starts(stroke)).count()
    };
    assert_eq!((from_apex(&coned), from_apex(&by(&scene, LightBounds::Sphere))), (8, 0));
}

fn distance_of(a: [f32; 2], b: [f64; 2]) -> f64 {
    (f64::from(a[0]) - b[0]).hypot(f64::from(a[1]) - b[1])
}

#[test]
fn the_scissor_is_a_slice_of_the_frustum() {
    let (mut scene, settings) = scene();
    scene.lights[0].range = 4.0;
    let plan = planned(&scene, &settings);
    let counted = planned(&scene, &Settings { show: Show::Shadow, ..settings.clone() });
    let eye = counted.views[0].camera;
    let of_light = counted.draws().filter(|(_, draw)| draw.light == Some(0)).map(|(_, draw)| draw.scissor);
    let [x, y, width, height] = of_light.max_by_key(|rect| rect[2] * rect[3]).unwrap();
    assert!(x > 8 && y + height <= SIZE[1] && x + width <= SIZE[0], "the lamp is to the right: {x} {width}");
    let slices: Vec<_> = strokes(&plan).into_iter().filter(|stroke| stroke.fill.is_some() && stroke.width == 2.0).collect();
    let held = |pixel: [f64; 2]| {
        // Where the eye's ray through that pixel is halfway to the floor.
        let corners = eye.near_rectangle_of([pixel[0] as u32, pixel[1] as u32, 1, 1], SIZE);
        let way = (corners.iter().sum::<DVec3>() / 4.0 - eye.eye).normalize();
        let at = pixel_of(&plan, eye.eye + way * 3.0).unwrap();
        slices.iter().any(|slice| {
            let points = &slice.points;
            let turns = (0..points.len()).map(|index| {
                let ([ax, ay], [bx, by]) = (points[index].map(f64::from), points[(index + 1) % points.len()].map(f64::from));
                (bx - ax) * (at[1] - ay) - (by - ay) * (at[0] - ax)
            });
            let turns: Vec<_> = turns.collect();
            points.len() > 8 && (turns.iter().all(|turn| *turn > 0.0) || turns.iter().all(|turn| *turn < 0.0))
        })
    };
    let middle = f64::from(SIZE[1]) * 0.6;
    assert!(held([f64::from(x) + f64::from(width) * 0.5, middle]), "in the scissor's middle");
    assert!(held([f64::from(x) + 6.0, middle]) && !held([f64::from(x) - 6.0, middle]), "about its left border");
}

#[test]
fn volumes_are_glass_the_thinner_the_more_there_are() {
    let alphas = |scene: &Scene, settings: &Settings| -> Vec<f32> {
        let plan = planned(scene, settings);
        plan.draws().filter(|(_, draw)| draw.program == Program::VolumeGlass).map(|(_, draw)| draw.constant[3]).collect()
    };
    let (few, settings) = scene();
    let few = alphas(&few, &settings);
    let many = stock::build("stairs").unwrap().unwrap();
    let many = alphas(&many, &Settings { camera: CameraChoice::First, ..settings });
    assert!(!few.is_empty() && !many.is_empty());
    assert!(few.iter().all(|alpha| *alpha > 0.05), "{few:?}");
    assert!(many.iter().all(|alpha| *alpha > 0.01 && *alpha < few[0] * 0.7), "{many:?} of {few:?}");
}

#[test]
fn casters_have_their_cases_colours_also_out_of_the_eyes_view() {
    let mut stage = Stage::new();
    let (scene, settings) = scene();
    stage.set_scene(&scene);
    let shot = stage.shoot(&settings, &scene);
    let hue = |[r, g, b]: [f32; 3]| {
        let mean = (r + g + b) / 3.0;
        [r - mean, g - mean, b - mean].map(|part| part / mean)
    };
    let class_at = |place: DVec3| {
        let found = hue(color(&shot, pixel_of(&shot.plan, place).unwrap()));
        let near = |class: &Class| distance(found, hue(class.color()));
        Class::ALL.into_iter().min_by(|a, b| near(a).total_cmp(&near(b))).unwrap()
    };
    // The tops of the three cubes, beside the lines that cross them.
    assert_eq!(class_at(DVec3::new(0.3, 1.0, -6.2)), Class::One);
    assert_eq!(class_at(DVec3::new(3.2, 1.0, -1.7)), Class::Two);
    assert_eq!(class_at(DVec3::new(-6.2, 1.0, -4.2)), Class::LeftOut);
    let cases = planned(&scene, &Settings { show: Show::Cases, ..settings.clone() });
    assert_eq!(cases.volumes, shot.plan.volumes, "both shows tell the same");
    let lit = planned(&scene, &Settings { show: Show::Final, ..settings });
    assert_eq!(lit.volumes, shot.plan.volumes, "and so does the picture");
}

#[test]
fn everything_is_in_the_view_from_above() {
    for row in stock::TABLE {
        let scene = stock::build(row.name).unwrap().unwrap();
        let settings = Settings { show: Show::Bounds, size: SIZE, ..Settings::default() };
        let (pose, plan) = stage(&settings, &scene, &Capabilities::complete()).unwrap();
        let eye = Camera::choose(&settings, &scene, &pose).unwrap().eye;
        assert!(pixel_of(&plan, eye).is_some(), "{}: the eye", row.name);
        for (node, _, _) in scene.instances().filter(|(_, node, _)| node.casts_shadow) {
            for corner in pose.world_bounds(&scene, node).corners() {
                assert!(pixel_of(&plan, corner).is_some(), "{}: {}", row.name, scene.nodes[node].name);
            }
        }
        assert!(plan.draws().any(|(_, draw)| draw.program == Program::Lines), "{}", row.name);
    }
}

#[test]
fn what_covers_the_eye_is_cut_away_and_nothing_else() {
    let mut stage = Stage::new();
    let room = |roofed: bool| {
        let mut build = Build::new();
        build.floor(0.0, 5.0);
        let slab = build.mesh(cube(0));
        let shift = if roofed { 0.0 } else { 6.0 };
        build.place(slab, DVec3::new(shift, 3.1, 0.0), DVec3::new(2.5, 0.1, 2.5));
        build.place(slab, DVec3::new(1.2, 0.3, -1.2), DVec3::splat(0.3));
        // A wall that is cut open with the roof.
        build.place(slab, DVec3::new(-2.0, 1.55, 0.0), DVec3::new(0.4, 1.45, 2.0));
        build.point_light(DVec3::new(-1.0, 2.0, 0.5));
        let settings = seen_from(DVec3::new(0.0, 1.0, 1.5), DVec3::new(0.0, 0.5, -3.0), SIZE);
        (build.0, Settings { show: Show::Bounds, technique: Technique::Auto, ..settings })
    };
    for roofed in [true, false] {
        let (scene, settings) = room(roofed);
        stage.set_scene(&scene);
        let shot = stage.shoot(&settings, &scene);
        let told = shot.plan.notes.iter().any(|note| note.contains("cut away"));
        assert_eq!(told, roofed, "{:?}", shot.plan.notes);
        // The small cube under the roof, or beside it, is seen: bluer than the floor is.
        let [r, _, b] = color(&shot, pixel_of(&shot.plan, DVec3::new(1.2, 0.6, -1.2)).unwrap());
        assert!(b > r * 1.5 && b > 0.5, "roofed {roofed}: {r} {b}");
        // The inside of the wall is dark where it is cut; where it is whole its top is not.
        let camera = shot.plan.views[0].camera;
        let top = if roofed { camera.eye.y - camera.near } else { 3.0 };
        let wall = color(&shot, pixel_of(&shot.plan, DVec3::new(-2.0, top, 1.7)).unwrap());
        assert_eq!(wall.iter().all(|value| *value < 0.25), roofed, "roofed {roofed}: {wall:?}");
    }
    // The roof is there from above when the eye stands beside it.
    let (scene, settings) = room(true);
    let beside = seen_from(DVec3::new(0.0, 1.0, 4.5), DVec3::new(0.0, 0.5, -3.0), SIZE);
    let plan = planned(&scene, &Settings { camera: beside.camera, ..settings });
    assert!(!plan.notes.iter().any(|note| note.contains("cut away")), "{:?}", plan.notes);
}

#[test]
fn every_way_to_bound_a_light_gives_the_same_pixels() {
    const VIEWS: usize = 8;
    let size = [160, 90];
    let mut stage = Stage::new();
    let mut smaller = [0; LightBounds::ALL.len()];
    for name in ["projector", "courtyard", "shadowfun"] {
        let scene = stock::build(name).unwrap().unwrap();
        stage.set_scene(&scene);
        let base = Settings { size, technique: Technique::Auto, ..Settings::default() };
        // Spots first: they alone have cones.
        let spot = scene.lights.iter().position(|light| matches!(light.kind, LightKind::Spot { .. }));
        for stray in strays(&scene, &base, spot, VIEWS, 7) {
            let mut settings = stray.settings;
            let by = |light_bounds| Culling { light_bounds, ..Culling::default() };
            for show in [Show::Shadow, Show::Final] {
                settings.show = show;
                settings.culling = by(LightBounds::None);
                let expected = stage.shoot(&settings, &scene);
                for (index, bounds) in LightBounds::ALL.into_iter().enumerate() {
                    settings.culling = by(bounds);
                    let shot = stage.shoot(&settings, &scene);
                    // A light that is not added at all leaves a sum whose last bits may differ.
                    let most = if show == Show::Shadow { 0 } else { 1 };
                    let differs = expected.image.as_raw().iter().zip(shot.image.as_raw()).any(|(a, b)| a.abs_diff(*b) > most);
                    assert!(!differs, "{} bounds: {}", bounds.name(), obscura::cli::render_command(&settings));
                    let area = |plan: &FramePlan| {
                        let of_light = plan.draws().filter(|(_, draw)| draw.light == Some(settings.light));
                        of_light.map(|(_, draw)| draw.scissor[2] * draw.scissor[3]).max().unwrap_or(0)
                    };
                    smaller[index] += usize::from(area(&shot.plan) < area(&expected.plan));
                }
            }
        }
    }
    let [none, others @ ..] = smaller;
    assert!(none == 0 && others.iter().all(|count| *count > 3), "each bounds something somewhere: {smaller:?}");
}

/// Where a ray of `show rays` ends on a surface, its count is what that pixel's stencil must hold.
#[test]
fn rays_end_with_the_count_of_their_pixels() {
    // The rays go through the middles of pixels.
    let size = [161, 105];
    let mut compared = [0; 2];
    for (name, light) in [("cubes", 0), ("eye-in-shadow", 0), ("hello2rts", 1)] {
        let scene = stock::build(name).unwrap().unwrap();
        let settings = Settings { size, light, show: Show::Rays, ..Settings::default() };
        let (pose, plan) = stage(&settings, &scene, &Capabilities::complete()).unwrap();
        assert_eq!(plan.views[0].name, "side");
        let eye = Camera::choose(&settings, &scene, &pose).unwrap();
        let expected = World::new(&scene, &pose).counts(&eye, &pose.lights[light], size);
        for ray in rays(&scene, &pose, &eye, light).iter().filter(|ray| ray.hits) {
            let row = ((1.0 - ray.height) / 2.0 * f64::from(size[1])) as usize;
            let Some(count) = expected[row * size[0] as usize + 80] else { continue };
            let found = ray.legs.last().unwrap().1;
            assert_eq!(found, u32::from(count), "{name}, row {row}: {ray:?}");
            compared[usize::from(count > 0)] += 1;
        }
    }
    assert!(compared.iter().all(|rays| *rays >= 4), "{compared:?} rays end in light, in shadow");
}
