//! `obscura bench --sweep`: one thing is doubled again and again, everything else stays as it is, and each picture is
//! measured as [`super::bench`] measures it. Written are a table, and a plot of it.

use std::fmt::Write as _;
use std::path::Path;

use super::bench::{Bench, Report, Row};
use super::plot::{Curve, Plot};
use super::save::{save_bytes, save_png};
use super::{HeadlessError, check_exists, progress_bar};
use crate::cli::{Sweep, SweepRequest, check};
use crate::scene::{Scene, generated};
use crate::settings::{Settings, Technique};

/// One point: how many there are of what is doubled, and the picture.
struct Point {
    count: u64,
    settings: Settings,
    /// Where each point has a scene of its own.
    build: Option<fn(u32) -> Scene>,
}

/// Measures what is asked for, and writes both files.
///
/// # Errors
/// Whatever stands in the way; nothing is written then.
pub fn sweep(request: &SweepRequest) -> Result<Report, HeadlessError> {
    let points: Vec<_> = (0..request.steps).map(|step| point(request, step)).collect();
    for point in &points {
        check(&point.settings)?;
        check_exists(&point.settings.scene)?;
    }
    std::fs::create_dir_all(&request.out).map_err(|error| HeadlessError::Folder(request.out.clone(), error))?;
    let mut bench = Bench::new(&request.settings)?;
    let frames = u64::from(request.steps) * request.techniques.len() as u64 * u64::from(request.frames);
    let progress = progress_bar(frames);
    let mut rows: Vec<(u64, Row)> = Vec::new();
    let mut kept: Option<Scene> = None;
    for (step, point) in (0..).zip(&points) {
        let scene = match (point.build, kept.take()) {
            (Some(build), _) => build(step),
            (None, Some(scene)) => scene,
            (None, None) => super::render::open(&point.settings)?,
        };
        bench.set_scene(&scene)?;
        for &technique in &request.techniques {
            progress.set_message(format!("{} {} {}", point.count, request.sweep.name(), technique.name()));
            let settings = Settings { technique, ..point.settings.clone() };
            let mut row = bench.measure(&scene, &settings, request.frames, &progress)?;
            if request.sweep == Sweep::Bounces {
                row.scene = format!("{}, {} bounces", row.scene, point.count);
            }
            rows.push((point.count, row));
        }
        kept = Some(scene);
    }
    progress.finish_and_clear();
    let report = Report { adapter: bench.adapter().into(), rows: rows.iter().map(|(_, row)| row.clone()).collect() };
    let file = |ending: &str| request.out.join(format!("{}.{ending}", request.sweep.name()));
    let picture = plot(request, &report.adapter, &rows).draw()?;
    write(&file("csv"), &csv(request.sweep, &rows))?;
    save_png(&file("png"), &picture, &request.command())?;
    Ok(report)
}

fn write(path: &Path, text: &str) -> Result<(), HeadlessError> {
    Ok(save_bytes(path, text.as_bytes())?)
}

fn point(request: &SweepRequest, step: u32) -> Point {
    let doubled = 1u64 << step;
    let mut settings = request.settings.clone();
    let of = |count, settings, build: fn(u32) -> Scene| Point { count, settings, build: Some(build) };
    match request.sweep {
        Sweep::Casters => of(doubled, settings, |step| generated::casters(1 << step)),
        Sweep::Triangles => of(generated::FEWEST_TRIANGLES * doubled, settings, generated::triangles),
        Sweep::Lights => of(doubled, settings, |step| generated::lights(1 << step)),
        Sweep::Bounces => {
            settings.mirrors.bounces = 1 << step;
            Point { count: doubled, settings, build: None }
        }
        Sweep::Pixels => {
            let larger = 2f64.powf(f64::from(step) / 2.0);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "pixels; what is too large stays so")]
            let size = settings.size.map(|side| (f64::from(side) * larger).round() as u32);
            settings.size = size;
            Point { count: u64::from(size[0]) * u64::from(size[1]), settings, build: None }
        }
    }
}

/// One line for each point and technique, with what [`Row`] has.
fn csv(sweep: Sweep, rows: &[(u64, Row)]) -> String {
    let mut text = format!(
        "{},technique,width,height,frames,frame_ms,frame_ms_p10,frame_ms_p90,cpu_ms,cpu_ms_p10,cpu_ms_p90,gpu_ms,gpu_ms_p10,\
         gpu_ms_p90,fragments_per_pixel,volume_triangles,indices\n",
        sweep.name()
    );
    for (count, row) in rows {
        let Row { technique, width, height, frames, fragments_per_pixel, volume_triangles, indices, .. } = row;
        // Writing to a string cannot fail.
        let _ = write!(text, "{count},{},{width},{height},{frames}", technique.name());
        for spread in [Some(row.frame_ms), Some(row.cpu_ms), row.gpu_ms] {
            let _ = match spread {
                Some(spread) => write!(text, ",{:.4},{:.4},{:.4}", spread.median, spread.p10, spread.p90),
                None => write!(text, ",,,"),
            };
        }
        let _ = writeln!(text, ",{fragments_per_pixel:.4},{volume_triangles},{indices}");
    }
    text
}

/// Whole frames, and in dashes this thread's part of them.
fn plot(request: &SweepRequest, adapter: &str, rows: &[(u64, Row)]) -> Plot {
    #[expect(clippy::cast_precision_loss, reason = "counts far below 2^53")]
    let curve = |technique: Technique, name: String, dashed: bool, of: fn(&Row) -> f64| {
        let rows = rows.iter().filter(|(_, row)| row.technique == technique);
        Curve { name, color: color(technique), dashed, points: rows.map(|(count, row)| [*count as f64, of(row)]).collect() }
    };
    let techniques = &request.techniques;
    let whole = techniques.iter().map(|&technique| curve(technique, technique.name().into(), false, |row| row.frame_ms.median));
    let cpu = techniques.iter().map(|&technique| curve(technique, String::new(), true, |row| row.cpu_ms.median));
    let [width, height] = request.settings.size;
    let (x, where_to) = match request.sweep {
        Sweep::Casters => ("casters", format!("boxes on a floor, {width} x {height}")),
        Sweep::Triangles => ("triangles of the caster", format!("one knot over a floor, {width} x {height}")),
        Sweep::Lights => ("lights", format!("25 boxes on a floor, {width} x {height}")),
        Sweep::Bounces => ("bounces", format!("{}, {width} x {height}", scene_name(&request.settings))),
        Sweep::Pixels => ("pixels", scene_name(&request.settings)),
    };
    Plot {
        title: format!("{where_to}; {adapter}"),
        x: x.into(),
        y: "ms a frame (dashed: CPU)".into(),
        curves: cpu.chain(whole).collect(),
    }
}

fn scene_name(settings: &Settings) -> String {
    use crate::settings::SceneChoice;
    match &settings.scene {
        SceneChoice::Stock(name) => name.clone(),
        SceneChoice::File(path) => path.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned()),
    }
}

/// Colours that the colour-blind can tell apart (Okabe and Ito), those of usual techniques first.
fn color(technique: Technique) -> [u8; 3] {
    const OTHERS: [[u8; 3]; 4] = [[0x00, 0x9e, 0x73], [0xcc, 0x79, 0xa7], [0x56, 0xb4, 0xe9], [0xc9, 0xb8, 0x00]];
    match technique {
        Technique::None => [0x80, 0x80, 0x80],
        Technique::ZPass => [0xe6, 0x9f, 0x00],
        Technique::ZFail => [0xd5, 0x5e, 0x00],
        Technique::Auto => [0x00, 0x72, 0xb2],
        other => OTHERS[other as usize % OTHERS.len()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::headless::bench::Spread;

    fn request(sweep: Sweep) -> SweepRequest {
        SweepRequest {
            sweep,
            steps: 3,
            settings: Settings { size: [320, 180], ..Settings::default() },
            techniques: vec![Technique::None, Technique::Auto],
            frames: 2,
            out: "out".into(),
        }
    }

    #[test]
    fn each_point_has_twice_as_much_as_the_one_before() {
        for sweep in Sweep::ALL {
            let counts: Vec<_> = (0..3).map(|step| point(&request(sweep), step).count).collect();
            let near = |a: u64, b: u64| a.abs_diff(b) * 100 < b;
            assert!(near(counts[1], counts[0] * 2) && near(counts[2], counts[0] * 4), "{sweep:?}: {counts:?}");
        }
        assert_eq!(point(&request(Sweep::Pixels), 4).settings.size, [1280, 720]);
        assert_eq!(point(&request(Sweep::Bounces), 2).settings.mirrors.bounces, 4);
    }

    #[test]
    fn the_table_has_a_line_for_each_row_and_a_number_in_each_column() {
        let row = |technique, gpu_ms| Row {
            scene: "s".into(),
            technique,
            width: 4,
            height: 3,
            frames: 2,
            frame_ms: Spread { median: 1.5, p10: 1.0, p90: 2.0 },
            cpu_ms: Spread::default(),
            gpu_ms,
            fragments_per_pixel: 0.25,
            volume_triangles: 7,
            indices: 21,
        };
        let rows = [(1, row(Technique::None, None)), (2, row(Technique::ZPass, Some(Spread::default())))];
        let text = csv(Sweep::Lights, &rows);
        let lines: Vec<Vec<_>> = text.lines().map(|line| line.split(',').collect()).collect();
        assert_eq!(lines.len(), 3);
        assert!(lines.iter().all(|line| line.len() == lines[0].len()), "{text}");
        assert_eq!(&lines[1][..8], ["1", "none", "4", "3", "2", "1.5000", "1.0000", "2.0000"]);
        assert_eq!(lines[1][11], "", "no timestamps");
        let plot = plot(&request(Sweep::Lights), "device", &rows);
        assert_eq!(plot.curves.len(), 4);
        assert_eq!(plot.curves[2].points, [[1.0, 1.5]]);
    }
}
