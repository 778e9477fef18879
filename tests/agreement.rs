//! Z-fail and exact z-pass agree in every stencil value, on 200 random views of the stock scenes; so do
//! one-sided and per-polygon counting, on every fourth of them, and auto with everything culled.
//! ZP+ may crack, and how much is counted.
//!
//! Eye and light are thrown through and around each scene by a fixed seed: also into shadows, into
//! casters, and with casters across the near plane.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test fails by panicking")]

mod common;

use std::collections::{BTreeMap, BTreeSet};

use common::Stage;
use glam::DVec3;
use obscura::cli::render_command;
use obscura::frame::{Case, DrawSet, FramePlan, Method, Reason};
use obscura::scene::{AnimationChoice, LightKind, Scene, pose, stock};
use obscura::settings::{
    CameraChoice, Counting, Culling, LightBounds, LightEdit, MirrorMode, Overflow, SceneChoice, Settings, Show, Technique,
};

const VIEWS_PER_SCENE: usize = 44;
const SIZE: [u32; 2] = [200, 112];

/// SplitMix64: the same numbers on every machine.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, low: DVec3, high: DVec3) -> DVec3 {
        low + (high - low) * DVec3::new(self.unit(), self.unit(), self.unit())
    }
}

/// A view of `scene`, and one of its lights.
fn view(scene: &Scene, view: usize, random: &mut Random) -> Settings {
    let time = random.unit() * 20.0;
    let posed = pose::pose(scene, time, AnimationChoice::All, &BTreeMap::new());
    // Where the casters are: floors reach much farther than what stands on them.
    let mut bounds = obscura::geometry::Aabb::EMPTY;
    for (node_index, node, _) in scene.instances() {
        if node.casts_shadow {
            bounds = bounds.union(&posed.world_bounds(scene, node_index));
        }
    }
    let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let margin = (high - low) * 0.2;
    // Every third eye stands close to some caster's own box, so that near planes are crossed.
    let eye = if view.is_multiple_of(3) {
        let casters: Vec<_> = scene.instances().filter(|(_, node, _)| node.casts_shadow).map(|(index, ..)| index).collect();
        let chosen = casters[(random.unit() * casters.len() as f64) as usize];
        let near = posed.world_bounds(scene, chosen);
        random.between(near.min.as_dvec3() - 0.15, near.max.as_dvec3() + 0.15)
    } else {
        random.between(low - margin, high + margin)
    };
    let target = random.between(low, high);
    let light = (random.unit() * scene.lights.len() as f64) as usize;
    let mut settings = Settings {
        show: Show::Stencil,
        size: SIZE,
        time,
        light,
        camera: CameraChoice::Free { eye, target },
        // The stencil's own count, modulo 256: not what is done where that is too few.
        counting: Counting { overflow: Overflow::Naive, ..Counting::default() },
        // Pieces have other vertices than wholes, and so other last bits of depth: tests/clamping.rs is about them.
        culling: Culling { clamping: false, ..Culling::default() },
        ..Settings::default()
    };
    if scene.lights[light].kind != LightKind::Directional {
        let position = Some(random.between(low - margin, high + margin));
        // Every fourth light ends within the scene.
        let range = if view % 4 == 3 { (high - low).length() as f32 * 0.3 } else { f32::INFINITY };
        settings.lights.insert(light, LightEdit { position, range: Some(range), ..LightEdit::default() });
    }
    settings
}

/// The command that draws a stock scene by these settings.
fn command(scene: &str, settings: &Settings) -> String {
    render_command(&Settings { scene: SceneChoice::Stock(scene.into()), ..settings.clone() })
}

#[test]
fn z_fail_and_exact_z_pass_hold_the_same_stencil_on_200_random_views() {
    let mut stage = Stage::new();
    let mut random = Random(20_261_122);
    let mut views = 0;
    let mut met: BTreeMap<Method, usize> = BTreeMap::new();
    let (mut in_shadow, mut z_pass_wrong, mut compared, mut same) = (0, 0, 0, 0);
    let mut cracked = Vec::new();
    for row in stock::TABLE {
        let scene = stock::build(row.name).unwrap().unwrap();
        // The rooms with mirrors are held against rays; here they would add nothing but time.
        if !scene.mirrors.is_empty() {
            continue;
        }
        stage.set_scene(&scene);
        for view in 0..VIEWS_PER_SCENE {
            let settings = self::view(&scene, view, &mut random);
            let light = settings.light;
            let mut stencil_by = |technique| {
                let shot = stage.shoot(&Settings { technique, ..settings.clone() }, &scene);
                (stage.stencil(), shot.plan)
            };
            let (by_z_fail, _) = stencil_by(Technique::ZFail);
            let (by_exact, plan) = stencil_by(Technique::ExactZPass);
            let (by_z_pass, _) = stencil_by(Technique::ZPass);
            // Where no surface is, or the light's range ends before it, the verdict is grey.
            let verdict = stage.shoot(&Settings { show: Show::Shadow, ..settings.clone() }, &scene).image;
            let surface: Vec<_> = verdict.pixels().map(|pixel| pixel.0[0] != 128).collect();
            let differ: Vec<_> = (0..by_z_fail.len()).filter(|&i| surface[i] && by_z_fail[i] != by_exact[i]).collect();
            assert!(
                differ.is_empty(),
                "{} view {view}, light {light}: {} pixels differ, the first at {},{}: z-fail {} exact z-pass {}; {}",
                row.name,
                differ.len(),
                differ[0] % SIZE[0] as usize,
                differ[0] / SIZE[0] as usize,
                by_z_fail[differ[0]],
                by_exact[differ[0]],
                command(row.name, &settings),
            );
            if view % 4 == 1 {
                for technique in [Technique::OneSided, Technique::PerPolygon] {
                    let plan = stage.shoot(&Settings { technique, ..settings.clone() }, &scene).plan;
                    let found = stage.stencil();
                    let differ = (0..found.len()).filter(|&i| surface[i] && found[i] != by_z_fail[i]).count();
                    assert_eq!(
                        differ,
                        0,
                        "{} view {view}, light {light}: {} differs from z-fail; {settings:?}",
                        row.name,
                        technique.name()
                    );
                    same += usize::from(plan.volumes.iter().any(|volume| volume.method != Method::Dropped));
                }
            }
            if view % 2 == 0 {
                let plan = stage.shoot(&Settings { technique: Technique::ZPlus, ..settings.clone() }, &scene).plan;
                let found = stage.stencil();
                let wrong = (0..found.len()).filter(|&i| surface[i] && found[i] != by_z_fail[i]).count();
                let over = plan.volumes.iter().any(|volume| matches!(volume.method, Method::ZPlus | Method::ZPlusMirrored));
                let told = command(row.name, &settings);
                assert!(wrong == 0 || over, "without a near plane's count there is nothing to crack: {wrong}; {told}");
                cracked.push((over, wrong));
            }
            in_shadow += usize::from(plan.volumes.iter().any(|volume| volume.holds_eye != 0));
            z_pass_wrong += usize::from((0..by_z_fail.len()).any(|i| surface[i] && by_z_pass[i] != by_z_fail[i]));
            compared += surface.iter().filter(|there| **there).count();
            for volume in &plan.volumes {
                *met.entry(volume.method).or_default() += 1;
            }
            views += 1;
        }
    }
    println!(
        "{views} views, {compared} pixels, {in_shadow} from inside a shadow, z-pass wrong in {z_pass_wrong}; volumes by method {met:?}"
    );
    assert!(views >= 200);
    // The views must have met what is hard, or their agreement says little.
    assert!(in_shadow >= 20 && z_pass_wrong >= 20, "too few eyes in shadow");
    // ZP+ cracks: single pixels along the near plane's cut, not areas.
    let cracks: usize = cracked.iter().map(|(_, wrong)| wrong).sum();
    let over = cracked.iter().filter(|(over, _)| *over).count();
    let most = cracked.iter().map(|(_, wrong)| *wrong).max().unwrap();
    let with = cracked.iter().filter(|(_, wrong)| *wrong > 0).count();
    println!(
        "ZP+: {cracks} cracks in {with} of {} views, {over} with a shadow near the near plane; at most {most}",
        cracked.len()
    );
    assert!(over >= 40 && cracks <= 10, "{over} views with a shadow near the near plane, {cracks} cracks");
    assert!(same >= 100, "one-sided and per-polygon counting met volumes in {same} views only");
    assert!(met.get(&Method::ExactZPass).is_some_and(|count| *count > 500), "{met:?}");
    assert!(met.get(&Method::ZFailCompared).is_some_and(|count| *count > 50), "{met:?}");
}

const CULLED_VIEWS_PER_SCENE: usize = 24;

/// Culling must not change a pixel: not the stencil of any surface in view, not the verdict of any in
/// the light's range, not the picture.
#[test]
fn auto_and_z_fail_with_everything_culled_draw_what_z_fail_draws_without() {
    let mut stage = Stage::new();
    let mut random = Random(20_031_107);
    let mut views = 0;
    let mut met: BTreeMap<(Option<Case>, Method, Reason), usize> = BTreeMap::new();
    let (mut caps_left_out, mut volumes, mut before, mut after) = (0, 0, 0, 0);
    for row in stock::TABLE {
        let scene = stock::build(row.name).unwrap().unwrap();
        // The rooms with mirrors are held against rays; here they would add nothing but time.
        if !scene.mirrors.is_empty() {
            continue;
        }
        stage.set_scene(&scene);
        for view in 0..CULLED_VIEWS_PER_SCENE {
            let settings = self::view(&scene, view, &mut random);
            let mut unculled = Settings { technique: Technique::ZFail, ..settings.clone() };
            unculled.culling = Culling { on: false, light_bounds: LightBounds::None, ..Culling::default() };
            // Z-fail itself leaves caps out; auto rarely comes to it.
            let technique = if view % 3 == 2 { Technique::ZFail } else { Technique::Auto };
            let mut culled = Settings { technique, ..settings.clone() };
            culled.culling.caster_scissors = view % 2 == 1;
            culled.culling.light_bounds = LightBounds::ALL[view % LightBounds::ALL.len()];
            let verdict = stage.shoot(&Settings { show: Show::Shadow, ..unculled.clone() }, &scene).image;
            let surface: Vec<_> = verdict.pixels().map(|pixel| pixel.0[0] != 128).collect();
            let told = |what: &str, at: usize| {
                let (x, y) = (at % SIZE[0] as usize, at / SIZE[0] as usize);
                format!("{what} differs at {x},{y}, view {view}; {}", command(row.name, &culled))
            };

            stage.shoot(&unculled, &scene);
            let expected = stage.stencil();
            stage.shoot(&culled, &scene);
            let differs = stage.stencil().iter().zip(&expected).zip(&surface).position(|((a, b), surface)| *surface && a != b);
            assert!(differs.is_none(), "{}", told("the stencil", differs.unwrap()));

            for (show, what) in [(Show::Shadow, "the verdict"), (Show::Final, "the picture")] {
                let mut unculled = Settings { show, ..unculled.clone() };
                if show == Show::Final {
                    // A light whose bounds are off screen is not added at all, instead of adding nothing, and
                    // the sum's last bits differ; so both have the same bounds.
                    unculled.culling.light_bounds = culled.culling.light_bounds;
                }
                let expected = stage.shoot(&unculled, &scene);
                let shot = stage.shoot(&Settings { show, ..culled.clone() }, &scene);
                let differs = shot.image.pixels().zip(expected.image.pixels()).position(|(a, b)| a != b);
                assert!(differs.is_none(), "{}", told(what, differs.unwrap()));
                (before, after) = (before + expected.stats.indices, after + shot.stats.indices);
                for volume in &shot.plan.volumes {
                    *met.entry((volume.case, volume.method, volume.reason)).or_default() += 1;
                    let caps = [volume.parts.light_cap, volume.parts.dark_cap];
                    caps_left_out += usize::from(volume.method == Method::ZFail && caps.contains(&false));
                    volumes += 1;
                }
            }
            views += 1;
        }
    }
    println!(
        "{views} views, {volumes} volumes, {caps_left_out} by z-fail without a cap, {before} indices became {after}: {met:#?}"
    );
    assert!(views >= 100);
    let of = |reason: Reason| met.iter().filter(|((_, _, it), _)| *it == reason).map(|(_, count)| *count).sum::<usize>();
    // The views must have met every decision, or their agreement says little.
    assert!(of(Reason::OutOfView) > 100 && of(Reason::OutOfRange) > 100, "{met:?}");
    assert!(of(Reason::ReachesNothing) > 0 && of(Reason::NearPlaneClear) > 500, "{met:?}");
    assert!(caps_left_out > 0 && after < before);
}

const BOUNDED_VIEWS_PER_SCENE: usize = 8;
/// Set in the stencil where a surface lies beyond its light's depth bounds.
const BEYOND: u8 = 0x80;

const WINDOWED_VIEWS_PER_SCENE: usize = 6;

/// Counting volumes only where their shadows may fall must not change a pixel, and must leave fragments out.
#[test]
fn within_footprints_every_exact_technique_draws_what_it_draws_without() {
    const TECHNIQUES: [Technique; 5] =
        [Technique::Auto, Technique::ZFail, Technique::ExactZPass, Technique::Wide, Technique::OneSided];
    let mut stage = Stage::new();
    let mut random = Random(20_031_107);
    let (mut windowed, mut several, mut everywhere) = (0, 0, 0);
    for (row, number) in stock::TABLE.iter().zip(0..) {
        let scene = stock::build(row.name).unwrap().unwrap();
        stage.set_scene(&scene);
        for view in 0..WINDOWED_VIEWS_PER_SCENE {
            let mut settings = self::view(&scene, 3, &mut random);
            settings.technique = TECHNIQUES[(view + number) % TECHNIQUES.len()];
            let told = || command(row.name, &settings);
            let whole = Settings { culling: Culling { footprints: false, ..settings.culling }, ..settings.clone() };
            for show in [Show::Shadow, Show::Final, Show::Stencil] {
                let [found, expected] =
                    [&settings, &whole].map(|settings| stage.shoot(&Settings { show, ..settings.clone() }, &scene));
                let differ = found.image.pixels().zip(expected.image.pixels()).filter(|(a, b)| a != b).count();
                assert_eq!(differ, 0, "{show:?}: {}", told());
                let windows = |plan: &FramePlan| -> Vec<Option<[u32; 4]>> {
                    let of_set = |set: &DrawSet| match set {
                        DrawSet::Volumes(parts) => parts.iter().map(|part| part.window).collect(),
                        _ => Vec::new(),
                    };
                    plan.draws().flat_map(|(_, draw)| of_set(&draw.set)).collect()
                };
                assert!(windows(&expected.plan).iter().all(Option::is_none), "{}", told());
                let windows = windows(&found.plan);
                windowed += windows.iter().flatten().count();
                everywhere += windows.iter().filter(|window| window.is_none()).count();
                several += usize::from(windows.iter().flatten().collect::<BTreeSet<_>>().len() > 1);
            }
        }
    }
    let met = format!("{windowed} parts in windows, {everywhere} everywhere; {several} frames of more than one window");
    println!("{met}");
    assert!(windowed > 1000 && several > 20 && everywhere > 10, "{met}");
}

/// Depth bounds must not change a pixel, whatever counts within them; and must leave pixels out, or they
/// are worth nothing.
#[test]
fn within_depth_bounds_every_technique_draws_what_it_draws_without() {
    const TECHNIQUES: [Technique; 8] = [
        Technique::ZFail,
        Technique::ExactZPass,
        Technique::Auto,
        Technique::Wide,
        Technique::OneSided,
        Technique::PerPolygon,
        Technique::ZPass,
        Technique::Parity,
    ];
    let mut stage = Stage::new();
    let mut random = Random(20_031_106);
    let (mut counted, mut left_out, mut cones, mut in_batches, mut starts) = (0, 0, 0, 0, 0);
    for (row, number) in stock::TABLE.iter().zip(0..) {
        let scene = stock::build(row.name).unwrap().unwrap();
        if scene.lights.iter().all(|light| light.kind == LightKind::Directional) {
            continue;
        }
        stage.set_scene(&scene);
        for view in 0..BOUNDED_VIEWS_PER_SCENE {
            // Such a view has a light that ends within the scene, unless it is directional; every other one a spot,
            // where there are any, to be bounded by its cone.
            let settings = std::iter::repeat_with(|| self::view(&scene, 3, &mut random));
            let is_spot = |light: usize| matches!(scene.lights[light].kind, LightKind::Spot { .. });
            let any_spot = view % 2 == 1 && (0..scene.lights.len()).any(is_spot);
            let wanted = |settings: &Settings| !settings.lights.is_empty() && (!any_spot || is_spot(settings.light));
            let mut settings = settings.into_iter().find(wanted).unwrap();
            // Mirrors take the bits that bounds are marked in.
            settings.mirrors.mode = MirrorMode::Off;
            settings.technique = TECHNIQUES[(view + number) % TECHNIQUES.len()];
            settings.culling.light_bounds =
                if view % 2 == 1 { LightBounds::Tight } else { [LightBounds::Sphere, LightBounds::Box][view / 2 % 2] };
            // One bit or two: batch after batch.
            let bits = if view % 3 == 2 { 1 + view as u32 % 2 } else { 8 };
            settings.counting = Counting { bits, overflow: Overflow::Exact };
            let mut bounded = settings.clone();
            bounded.culling.depth_bounds = true;
            let told = || command(row.name, &bounded);

            let light = settings.light;
            let by = |stage: &mut Stage, settings: &Settings, show| stage.shoot(&Settings { show, ..settings.clone() }, &scene);
            let verdict = by(&mut stage, &settings, Show::Shadow);
            let found = by(&mut stage, &bounded, Show::Shadow);
            assert!(found.image == verdict.image, "the verdict: {}", told());
            in_batches += usize::from(found.plan.steps.iter().any(|step| step.label.contains("collapse")));
            let counts = found.plan.volumes.iter().any(|volume| volume.method != Method::Dropped);
            let solid = found.plan.depth_bounds(light);
            assert_eq!(solid.is_some(), counts, "{}", told());

            by(&mut stage, &settings, Show::Stencil);
            let expected = stage.stencil();
            let shot = by(&mut stage, &bounded, Show::Stencil);
            starts += usize::from(shot.plan.volumes.iter().any(|volume| volume.holds_eye != 0));
            // A field of eight bits is one of seven here.
            let field = shot.plan.budget.shadow_mask() & !BEYOND;
            for ((pixel, stencil), expected) in verdict.image.pixels().zip(stage.stencil()).zip(expected) {
                let reached = pixel.0[0] != 128;
                assert!(!reached || stencil & BEYOND == 0, "a surface that the light reaches is not marked: {}", told());
                if reached && settings.counting.bits == 8 {
                    assert_eq!(stencil & field, expected & field, "{}", told());
                }
                counted += usize::from(reached);
                left_out += usize::from(stencil & BEYOND != 0);
            }

            let picture = by(&mut stage, &settings, Show::Final);
            let found = by(&mut stage, &bounded, Show::Final);
            let differ = found.image.pixels().zip(picture.image.pixels()).filter(|(a, b)| a != b).count();
            assert_eq!(differ, 0, "the picture: {}", told());
            cones += usize::from(found.plan.depth_bounds(light).is_some_and(|solid| solid.name() == "cone"));
        }
    }
    let met = format!(
        "{counted} pixels within bounds, {left_out} beyond; {cones} cones, {in_batches} in batches, {starts} from the eye's count"
    );
    println!("{met}");
    assert!(counted > 50_000 && left_out > 50_000 && cones > 0 && in_batches > 0 && starts > 0, "{met}");
}
