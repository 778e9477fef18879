//! `obscura render`: one picture. The same arguments give the same pixels every time.

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use super::HeadlessError;
use super::json::{Report, Timings};
use super::progress_bar;
use super::save::{check_target, save_png};
use crate::cli::{check, check_against, render_command};
use crate::director::{self, Planner};
use crate::gpu::{Context, GpuError, Renderer, readback};
use crate::scene::{Scene, stock};
use crate::settings::{SceneChoice, Settings, Show};
use crate::techniques::complexity::Tally;

/// Draws what `settings` say into the PNG file `out`. With `measured`, draws the last frame twice, for the
/// second one's time: the first one's is mostly compilation.
///
/// # Errors
/// Whatever stands in the way, before anything is written.
pub fn render(settings: &Settings, out: &Path, measured: bool) -> Result<Report, HeadlessError> {
    check(settings)?;
    check_target(out)?;
    let mut timings = Timings::default();
    let mut clock = Instant::now();
    let scene = open(settings)?;
    timings.open_ms = lap(&mut clock);
    tracing::info!("opened {} in {:.1} ms", scene.name, timings.open_ms);

    let context = Context::headless(settings.adapter.as_deref())?;
    let mut renderer = Renderer::new(&context, settings.shaders.as_deref())?;
    renderer.set_scene(&context, &scene)?;
    timings.upload_ms = lap(&mut clock);
    tracing::info!("uploaded it to {} in {:.1} ms", context.capabilities().adapter, timings.upload_ms);

    // All but the last of the frames whose mean the picture is.
    let frames = director::frames(settings);
    let bar = progress_bar(if frames > 1 { frames.into() } else { 0 });
    let mut planner = Planner::default();
    for frame in 0..frames - 1 {
        let (pose, plan) = planner.stage_frame(settings, &scene, context.capabilities(), frame)?;
        readback::picture(&context, &mut renderer, &plan, &scene, &pose)?;
        planner.take_back((pose, plan));
        bar.inc(1);
    }
    bar.finish_and_clear();
    timings.gather_ms = lap(&mut clock);
    let (pose, plan) = planner.stage_frame(settings, &scene, context.capabilities(), frames - 1)?;
    timings.plan_ms = lap(&mut clock);
    tracing::info!("planned {} steps, {} volumes in {:.1} ms", plan.steps.len(), plan.volumes.len(), timings.plan_ms);

    let (mut frame, picture) = readback::picture(&context, &mut renderer, &plan, &scene, &pose)?;
    timings.first_frame_ms = lap(&mut clock);
    tracing::info!("drew it in {:.1} ms, pipelines and read-back included", timings.first_frame_ms);
    if measured {
        (frame, _) = readback::picture(&context, &mut renderer, &plan, &scene, &pose)?;
        timings.second_frame_ms = lap(&mut clock);
    }
    let complexity = if settings.show == Show::Complexity { Some(tally(&context, &renderer, settings)?) } else { None };
    save_png(out, &picture, &render_command(settings))?;
    Ok(Report { complexity, ..Report::new(out, settings, &scene, &plan, context.capabilities(), frame, timings) })
}

/// Depth complexity in numbers, of the frame that was drawn last.
///
/// # Errors
/// What [`readback::stencil`] may return.
pub fn tally(context: &Context, renderer: &Renderer, settings: &Settings) -> Result<Tally, GpuError> {
    let stencil = readback::stencil(context, renderer)?;
    Ok(Tally::of(&stencil, settings.size[0], settings.complexity))
}

/// The scene that `settings` ask for, with the lights and animations they speak of.
///
/// # Errors
/// No such scene, a file that cannot be imported, a light or animation that is not in it.
pub fn open(settings: &Settings) -> Result<Scene, HeadlessError> {
    let scene = super::open_scene(&settings.scene, settings.floor)?;
    check_against(settings, &scene)?;
    Ok(put_together(settings, scene))
}

/// The scene with its two solids put together, where settings and scene have some ([`Scene::combined`]), as they are at the
/// settings' time; and with the partner that its picture dissolves into.
#[must_use]
pub fn put_together(settings: &Settings, scene: Scene) -> Scene {
    let mut scene = match scene.combination_at(settings) {
        Some(combination) => scene.combined(combination),
        None => scene,
    };
    scene.partner = settings.dissolve.scene.as_ref().and_then(|name| {
        let partner = stock::build(name)?.ok()?;
        let mut others = settings.clone().of_another_scene(SceneChoice::Stock(name.clone()));
        (others.dissolve.scene, others.time) = (None, settings.time);
        Some(Arc::new(put_together(&others, partner)))
    });
    scene
}

fn lap(clock: &mut Instant) -> f64 {
    let milliseconds = clock.elapsed().as_secs_f64() * 1e3;
    *clock = Instant::now();
    milliseconds
}
