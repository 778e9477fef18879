//! The program as a user meets it: the real binary, its exit codes, what it says, what it leaves.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)] // a test may stop where it stands

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use obscura::headless::read_command;
use obscura::scene::stock;
use obscura::settings::{Show, Technique};
use serde_json::Value;

/// A run of the program in a folder of its own, away from any display.
fn obscura(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_obscura"));
    command.current_dir(folder).stdin(Stdio::null());
    for variable in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET", "RUST_LOG"] {
        command.env_remove(variable);
    }
    command
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    obscura(folder).args(arguments).output().unwrap()
}

fn good(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// The one line on stderr, for bad input: exit code 1, nothing on stdout.
fn bad(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{arguments:?}: {said}");
    assert!(output.stdout.is_empty(), "{arguments:?}");
    // What Mesa's software driver says of itself is not ours to silence.
    let lines: Vec<_> = said.lines().filter(|line| !line.starts_with("WARNING: lavapipe")).collect();
    assert_eq!(lines.len(), 1, "{arguments:?}: {said}");
    assert!(lines[0].starts_with("obscura: error: "), "{arguments:?}: {said}");
    lines[0].to_owned()
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The folder of shared models: beside the checkout, or beside the folder of its worktrees.
fn shared_models() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    ["../shared/models", "../../shared/models"].iter().map(|path| root.join(path)).find(|path| path.is_dir())
}

const SMALL: [&str; 2] = ["--size", "96x54"];

#[test]
fn list_names_everything_there_is() {
    let folder = tempfile::tempdir().unwrap();
    let text = good(folder.path(), &["list"]);
    let json: Value = serde_json::from_str(&good(folder.path(), &["list", "--json"])).unwrap();
    let mut count = 0;
    for kind in ["scenes", "techniques", "shows"] {
        for entry in json[kind].as_array().unwrap() {
            let (name, about) = (entry["name"].as_str().unwrap(), entry["about"].as_str().unwrap());
            assert!(text.lines().any(|line| line.trim_start().starts_with(name) && line.contains(about)), "{name}");
            count += 1;
        }
    }
    assert_eq!(count, stock::TABLE.len() + Technique::ALL.len() + Show::ALL.len());
}

#[test]
fn a_reader_that_has_had_enough_is_no_error() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [&["list"][..], &["--help"], &["info", "cubes"]] {
        let mut child = obscura(folder.path()).args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{arguments:?}");
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
    }
}

#[test]
fn info_tells_what_every_stock_scene_is_made_of() {
    let folder = tempfile::tempdir().unwrap();
    let list: Value = serde_json::from_str(&good(folder.path(), &["list", "--json"])).unwrap();
    for scene in list["scenes"].as_array().unwrap() {
        let name = scene["name"].as_str().unwrap();
        let info: Value = serde_json::from_str(&good(folder.path(), &["info", name, "--json"])).unwrap();
        assert!(info.is_object(), "{name}");
        let text = good(folder.path(), &["info", name]);
        for word in ["triangle", "light", "camera", "closed"] {
            assert!(text.contains(word), "{name} says nothing of {word}s:\n{text}");
        }
    }
}

#[test]
fn the_same_arguments_give_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["--technique", "exact-z-pass", "--time", "1.5"];
    for out in ["a.png", "b.png"] {
        let stdout = good(folder.path(), &[&["render", "courtyard", "--out", out], &SMALL[..], &arguments].concat());
        assert_eq!(stdout, "");
    }
    let bytes = |name| std::fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("a.png") == bytes("b.png"));
    assert_eq!(names(folder.path()), ["a.png", "b.png"]);
    let picture = image::open(folder.path().join("a.png")).unwrap().to_rgb8();
    assert_eq!(picture.dimensions(), (96, 54));
    let first = picture.get_pixel(0, 0);
    assert!(picture.pixels().any(|pixel| pixel != first), "there is something in the picture");
}

#[test]
fn the_playground_draws_boards_and_prints_calls() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("b.json"), r#"{"shapes": [{"kind": "star", "front": {"reference": 3, "pass": "replace"}}]}"#)
        .unwrap();
    let text = good(here, &[&["playground", "b.json", "--numbers", "--out", "a.png", "--calls", "vulkan"], &SMALL[..]].concat());
    assert!(text.contains("VK_STENCIL_OP_REPLACE") && text.contains("// 1 star"), "{text}");
    assert_eq!(image::image_dimensions(here.join("a.png")).unwrap(), (96, 54));
    assert!(good(here, &["playground", "--calls", "wgpu"]).contains("set_stencil_reference(0x01)"), "without a picture");
    let words = shlex::split(&read_command(&here.join("a.png")).unwrap().unwrap()).unwrap();
    let words: Vec<_> = words.iter().skip(1).map(String::as_str).collect();
    good(here, &words);
    assert!(std::fs::read(here.join("a.png")).unwrap() == std::fs::read(here.join("obscura.png")).unwrap(), "{words:?}");
    std::fs::write(here.join("bad.json"), r#"{"shapes": [{"kind": "disc", "radius": 2}]}"#).unwrap();
    for (board, word) in [
        ("bad.json", "radius"),
        ("none.json", "table-2"),
        ("/dev/zero", "no file"),
        ("{}", "shapes"),
        (r#"{"shapes": [{"depth": 2}]}"#, "shape 1: its depth"),
        (r#"{"shapes": [{"front": {"reference": 256}}]}"#, "256"),
        (r#"{"shapes": [], "clear_depth": -1}"#, "depth is cleared"),
    ] {
        assert!(bad(here, &["playground", board, "--out", "c.png"]).contains(word), "{board}");
        assert!(bad(here, &["render", "cubes", "--board", board, "--out", "c.png"]).contains(word), "{board}");
    }
    assert!(bad(here, &["playground", "--calls", "metal"]).contains("wgpu, vulkan, d3d12, opengl"));
}

#[test]
fn depth_complexity_is_printed() {
    let folder = tempfile::tempdir().unwrap();
    let line = [&["render", "cubes", "--show", "complexity", "--complexity", "fragments", "--out", "a.png"], &SMALL[..]].concat();
    let text = good(folder.path(), &line);
    assert!(text.starts_with("fragments a pixel: ") && text.contains(" on average") && text.lines().count() == 1, "{text}");
    let report: Value = serde_json::from_str(&good(folder.path(), &[&line[..], &["--json"]].concat())).unwrap();
    let (average, most) = (report["complexity"]["average"].as_f64().unwrap(), report["complexity"]["maximum"].as_u64().unwrap());
    assert!(text.contains(&format!("{average:.3} on average")) && text.contains(&format!("{most} at most")), "{text}");
    assert!(bad(folder.path(), &["render", "cubes", "--out", "a.png", "--complexity", "depth"]).contains("updates, fragments"));
    assert!(bad(folder.path(), &["render", "cubes", "--out", "a.png", "--diagram", "side"]).contains("rays, slice, ends"));
    let unknown = bad(folder.path(), &["render", "cubes", "--out", "a.png", "--dissolve-scene", "nowhere"]);
    assert!(unknown.contains("stock scene") && unknown.contains("courtyard, cubes"), "{unknown}");
    assert!(bad(folder.path(), &["render", "cubes", "--out", "a.png", "--decals", "on"]).contains("z-fighting, offset, stencil"));
}

#[test]
fn the_command_in_a_picture_draws_it_again() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["--eye", "-3.1,2.7,4.9", "--target", "0.1,0.4,-0.3", "--light-edit", "0:color=1;0.5;0.1,shadows=false"];
    good(folder.path(), &[&["render", "cubes", "--out", "a.png"], &SMALL[..], &arguments].concat());
    let path = folder.path().join("a.png");
    let words = shlex::split(&read_command(&path).unwrap().unwrap()).unwrap();
    let words: Vec<_> = words.iter().skip(1).map(String::as_str).collect();
    good(folder.path(), &words);
    let again = folder.path().join("obscura.png");
    assert!(std::fs::read(path).unwrap() == std::fs::read(again).unwrap());
}

#[test]
fn json_tells_the_plan_and_the_time() {
    let folder = tempfile::tempdir().unwrap();
    let json = good(folder.path(), &[&["render", "eye-in-shadow", "--out", "a.png", "--json"], &SMALL[..]].concat());
    let report: Value = serde_json::from_str(&json).unwrap();
    assert_eq!(report["size"], serde_json::json!([96, 54]));
    assert_eq!(report["technique"], "auto");
    assert!(!report["adapter"].as_str().unwrap().is_empty());
    assert!(report["steps"].as_array().unwrap().iter().all(|step| step["label"].is_string() && step["why"].is_string()));
    let lights = report["volumes"].as_array().unwrap();
    let counted = lights.iter().flat_map(|light| light["counted"].as_array().unwrap());
    let casters: u64 = counted.map(|group| group["casters"].as_u64().unwrap()).sum();
    assert!(casters > 0, "{lights:?}");
    let listed = report["casters"].as_array().unwrap();
    assert_eq!(listed.len() as u64, casters, "no light of this scene has a size");
    for caster in listed {
        let mut keys: Vec<_> = caster.as_object().unwrap().keys().map(String::as_str).collect();
        keys.sort_unstable();
        assert_eq!(keys, ["case", "caster", "light", "method", "reason"]);
        assert!(caster["case"].as_u64().is_some_and(|case| (1..=3).contains(&case)) || caster["method"] == "dropped");
    }
    assert!(report["frame"]["draws"].as_u64().unwrap() > 0);
    assert!(report["timings"]["second_frame_ms"].as_f64().unwrap() > 0.0);
}

#[test]
fn json_tells_mirrors_and_the_views_in_them() {
    let folder = tempfile::tempdir().unwrap();
    let report = |arguments: &[&str]| -> Value {
        let json = good(folder.path(), &[&["render", "--out", "a.png", "--json"], &SMALL[..], arguments].concat());
        serde_json::from_str::<Value>(&json).unwrap()["reflections"].clone()
    };
    let views = |reflections: &Value| reflections["views"].as_array().unwrap().len() as u64;
    let deep = report(&["barbershop", "--bounces", "3"]);
    assert_eq!((&deep["mode"], &deep["bounces"]), (&Value::from("recursive"), &Value::from(3)));
    let mirrors = deep["mirrors"].as_array().unwrap();
    assert_eq!(mirrors.len(), 2, "{deep}");
    assert!(mirrors.iter().all(|mirror| mirror["reflectivity"].as_f64().is_some_and(|share| share > 0.5)));
    assert!(views(&deep) > 2 && views(&deep) <= deep["worst_case"].as_u64().unwrap(), "{deep}");
    assert_eq!(deep["worst_case"], 7, "1 + 2 (1 + 1 + 1)");
    let one = report(&["barbershop", "--mirrors", "stencil"]);
    assert!(views(&one) < views(&deep) && one["worst_case"] == 3, "{one}");
    let off = report(&["barbershop", "--mirrors", "off"]);
    assert!(views(&off) == 1 && off["mirrors"].as_array().unwrap().is_empty() && off["worst_case"] == 1, "{off}");
    let place = |mirror: &Value| format!("{}:{}", mirror["node"], mirror["primitive"]);
    let none = format!("{}=off", place(&mirrors[0]));
    let other = report(&["barbershop", "--mirror", &none]);
    assert_eq!(other["mirrors"].as_array().unwrap().iter().map(place).collect::<Vec<_>>(), [place(&mirrors[1])]);
    // A cube is no plane; the picture is drawn without it being a mirror.
    let scene = obscura::scene::stock::build("cubes").unwrap().unwrap();
    let (cube, ..) = scene.instances().find(|(_, node, _)| node.casts_shadow).unwrap();
    let refused = report(&["cubes", "--mirror", &format!("{cube}=on")]);
    assert!(refused["mirrors"].as_array().unwrap().is_empty());
    let [why] = &refused["refused"].as_array().unwrap()[..] else { panic!("{refused}") };
    assert!(why.as_str().unwrap().contains("off one plane"), "{why}");
}

#[test]
fn every_technique_and_show_draws() {
    let folder = tempfile::tempdir().unwrap();
    let mut pictures = Vec::new();
    let shows = Show::ALL.into_iter().map(|show| (Technique::ZFail, show));
    for (technique, show) in shows.chain(Technique::ALL.into_iter().map(|technique| (technique, Show::Final))) {
        let out = format!("{}-{}.png", technique.name(), show.name());
        let choice = ["--technique", technique.name(), "--show", show.name(), "--out", &out];
        good(folder.path(), &[&["render", "eye-in-shadow"], &SMALL[..], &choice].concat());
        pictures.push((technique, show, image::open(folder.path().join(out)).unwrap().to_rgb8()));
    }
    // What is shown makes a difference, and so do shadows; z-pass fails here, on purpose.
    let of = |technique, show| &pictures.iter().find(|one| (one.0, one.1) == (technique, show)).unwrap().2;
    for show in [Show::Stencil, Show::Shadow, Show::Volumes, Show::Wireframe] {
        assert!(of(Technique::ZFail, show) != of(Technique::ZFail, Show::Final), "{show:?}");
    }
    for technique in [Technique::None, Technique::ZPass] {
        assert!(of(technique, Show::Final) != of(Technique::ZFail, Show::Final), "{technique:?}");
    }
}

#[test]
fn bad_input_is_one_line_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    std::fs::write(here.join("empty.glb"), "").unwrap();
    std::fs::write(here.join("noise.glb"), [0xA5; 300]).unwrap();
    std::fs::write(here.join("truncated.glb"), b"glTF\x02\0\0\0\xff\0\0\0\x10\0\0\0JSON{").unwrap();
    std::fs::write(here.join("text.gltf"), "once upon a time").unwrap();
    std::fs::create_dir(here.join("folder.glb")).unwrap();
    let before = names(here);
    let cases: &[(&[&str], &str)] = &[
        (&["courtyad"], "stock scenes are: "),
        (&["missing.glb"], "missing.glb"),
        (&["no/such/folder/a.glb"], "no/such/folder/a.glb"),
        (&["empty.glb"], "empty.glb"),
        (&["noise.glb"], "noise.glb"),
        (&["truncated.glb"], "truncated.glb"),
        (&["text.gltf"], "text.gltf"),
        (&["folder.glb"], "folder.glb"),
        (&[""], "empty"),
        (&["cubes", "--technique", "magic"], "there are: none, z-pass"),
        (&["cubes", "--show", "magic"], "there are: final"),
        (&["cubes", "--camera", "magic"], "no camera `magic`"),
        (&["cubes", "--camera", "99"], "no camera `99`"),
        (&["cubes", "--light", "99"], "no light 99"),
        (&["cubes", "--light", "18446744073709551616"], "no light"),
        (&["cubes", "--light-edit", "99:on=false"], "no light 99"),
        (&["cubes", "--animation", "99"], "no animation 99"),
        (&["cubes", "--size", "0x0"], "0x0"),
        (&["cubes", "--size", "96x0"], "96x0"),
        (&["cubes", "--size", "100000x100000"], "1 to 8192"),
        (&["cubes", "--size", "99999999999999999999x1"], "1 to 8192"),
        (&["cubes", "--samples", "2"], "2 samples"),
        (&["cubes", "--eye", "nan,0,0", "--target", "0,0,0"], "eye"),
        (&["cubes", "--eye", "0,0,0", "--target", "0,-inf,0"], "target"),
        (&["cubes", "--eye", "1,1,1", "--target", "1,1,1"], "same point"),
        (&["cubes", "--fov", "-1"], "field of view"),
        (&["cubes", "--fov", "180"], "field of view"),
        (&["cubes", "--time", "-0.5"], "time"),
        (&["cubes", "--time", "nan"], "time"),
        (&["cubes", "--exposure", "inf"], "exposure"),
        (&["barbershop", "--mirrors", "magic"], "there are: off, unbounded, stencil, recursive"),
        (&["barbershop", "--bounces", "0"], "1 to 8"),
        (&["barbershop", "--bounces", "9"], "1 to 8"),
        (&["barbershop", "--last-bounce", "magic"], "there are: grey, fade"),
        (&["barbershop", "--mirror", "9999=on"], "node 9999"),
        (&["barbershop", "--mirror", "0:99=off"], "primitive 99"),
        (&["csg", "--csg", "magic"], "there are: off, union, intersection, a-minus-b, b-minus-a"),
        (&["cubes", "--csg", "union"], "--csg-a NODE"),
        (&["csg", "--csg-a", "9999"], "node 9999 cannot be A: it shows no mesh"),
        (&["csg", "--csg-b", "0"], "node 0 cannot be B: it is not closed"),
        (&["csg", "--csg-a", "4", "--csg-b", "4"], "A and B at once"),
        (&["cubes", "--halo", "9999"], "no node 9999"),
        (&["cubes", "--halo-color", "1,2,0"], "colour"),
        (&["cubes", "--halo-color", "1,nan,0"], "colour"),
        (&["cubes", "--halo-width", "-1"], "0 to 25"),
        (&["cubes", "--halo-width", "inf"], "0 to 25"),
        (&["cubes", "--planar", "magic"], "there are: off, naive, stencil-blend, stencil-relight, multi, hybrid"),
        (&["cubes", "--hybrid", "magic"], "there are: both, volumes, planar"),
        (&["cubes", "--receiver", "9999=on"], "node 9999"),
        (&["cubes", "--receiver", "0:99=off"], "primitive 99"),
        (&["cubes", "--light-edit", "0:position=0;nan;0"], "position"),
        (&["cubes", "--adapter", "no such adapter"], "no such adapter"),
        (&["cubes", "--shaders", "no-such-folder"], "no-such-folder"),
    ];
    for (arguments, expected) in cases {
        let message = bad(here, &[&["render", "--out", "a.png"], *arguments].concat());
        assert!(message.contains(expected), "{arguments:?}: {message}");
        assert_eq!(names(here), before, "{arguments:?}");
    }
    for (out, expected) in [("nowhere/a.png", "nowhere"), ("folder.glb", ".png"), ("a.jpg", ".png")] {
        let message = bad(here, &["render", "cubes", "--size", "8x8", "--out", out]);
        assert!(message.contains(expected), "{out:?}: {message}");
        assert_eq!(names(here), before, "{out:?}");
    }
    for scene in ["missing.glb", "noise.glb", "courtyad"] {
        assert!(bad(here, &["info", scene]).contains(scene));
    }
}

#[test]
fn figures_are_drawn_with_a_page_that_shows_them() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let said = good(here, &["figures", "k19c", "c", "--out", "figures", "--size", "96x54"]);
    assert!(said.starts_with("3 figures, and index.html that shows them, in "), "{said}");
    assert_eq!(names(&here.join("figures")), ["c01a.png", "c01b.png", "index.html", "k19c.png"]);
    let page = std::fs::read_to_string(here.join("figures/index.html")).unwrap();
    // Commands break between words, each of which is a span.
    let page = page.replace("<span>", "").replace("</span>", "");
    for part in ["src=\"k19c.png\"", "A minus B", "obscura render csg --out obscura.png --size 96x54", "Z-fail"] {
        assert!(page.contains(part), "{part}");
    }
    assert_eq!(image::image_dimensions(here.join("figures/k19c.png")).unwrap(), (96, 54));
    for (arguments, expected) in [
        (&["figures", "k99", "--out", "no"][..], "no figure `k99`; there are: k02a, "),
        (&["figures", "", "--out", "no"], "no figure ``"),
        (&["figures", "c", "--out", "no", "--size", "0x5"], "0x5"),
    ] {
        assert!(bad(here, arguments).contains(expected), "{arguments:?}");
    }
    assert_eq!(names(here), ["figures"]);
}

#[cfg(target_os = "linux")] // elsewhere other drivers than Vulkan's draw
#[test]
fn no_device_is_one_line_that_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let mut command = obscura(folder.path());
    // The Vulkan loader then finds no driver at all.
    command.env("VK_DRIVER_FILES", "/nonexistent").env("VK_ICD_FILENAMES", "/nonexistent");
    let output = command.args(["render", "cubes", "--out", "a.png"]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.starts_with("obscura: error: no graphics device"), "{said}");
    assert_eq!(names(folder.path()), Vec::<String>::new());
}

#[test]
fn a_failed_run_leaves_the_picture_that_was_there() {
    let folder = tempfile::tempdir().unwrap();
    good(folder.path(), &[&["render", "cubes", "--out", "a.png"], &SMALL[..]].concat());
    let before = std::fs::read(folder.path().join("a.png")).unwrap();
    bad(folder.path(), &["render", "cubes", "--out", "a.png", "--light", "99"]);
    assert!(std::fs::read(folder.path().join("a.png")).unwrap() == before);
    good(folder.path(), &[&["render", "cubes", "--technique", "none", "--out", "a.png"], &SMALL[..]].concat());
    assert!(std::fs::read(folder.path().join("a.png")).unwrap() != before);
    assert_eq!(names(folder.path()), ["a.png"]);
}

#[test]
fn wrong_usage_is_exit_code_2_and_says_what_is_wrong_first() {
    let folder = tempfile::tempdir().unwrap();
    for arguments in [
        &["render", "cubes"][..],
        &["render"],
        &["render", "cubes", "--out"],
        &["render", "cubes", "--out", ""],
        &["render", "cubes", "--out", "a.png", "--nonsense"],
        &["render", "cubes", "--out", "a.png", "--size", "large"],
        &["render", "cubes", "--out", "a.png", "--eye", "1,2,3"],
        &["render", "cubes", "--out", "a.png", "--fov", "wide"],
        &["render", "cubes", "--out", "a.png", "--mirror", "3"],
        &["render", "cubes", "--out", "a.png", "--mirror", "floor=on"],
        &["render", "cubes", "--out", "a.png", "--mirror", "1:0=perhaps"],
        &["render", "cubes", "--out", "a.png", "--receiver", "floor"],
        &["cubes", "--vsync", "perhaps"],
        &["cubes", "teapots"],
        &["info"],
    ] {
        let output = run(folder.path(), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(output.stdout.is_empty());
        assert!(output.stderr.starts_with(b"error: "), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    }
    assert_eq!(names(folder.path()), Vec::<String>::new());
}

#[test]
fn help_and_version_are_no_errors() {
    let folder = tempfile::tempdir().unwrap();
    assert!(good(folder.path(), &["--help"]).contains("render"));
    assert!(good(folder.path(), &["render", "--help"]).contains("exact-z-pass"));
    assert!(good(folder.path(), &["--version"]).starts_with("obscura "));
}

#[test]
fn a_window_without_a_display_points_to_render() {
    let folder = tempfile::tempdir().unwrap();
    let message = bad(folder.path(), &["cubes"]);
    assert!(message.contains("no display") && message.contains("obscura render"), "{message}");
}

#[test]
fn a_window_for_a_scene_that_is_not_there_does_not_open() {
    let folder = tempfile::tempdir().unwrap();
    // There is no such display, but that is not what is wrong first.
    let output = obscura(folder.path())
        .args(["no-such.glb"])
        .env("DISPLAY", ":4242")
        .env("OBSCURA_CONFIG_DIR", folder.path())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.starts_with("obscura: error: no scene or file `no-such.glb`"), "{said}");
}

#[test]
fn without_a_display_the_tour_starts_by_itself() {
    let folder = tempfile::tempdir().unwrap();
    // The whole tour takes long on a software device: it is enough to see it draw its first picture.
    let mut child = obscura(folder.path()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let out = folder.path().join("out");
    let whole = || -> Option<PathBuf> {
        let mut entries = std::fs::read_dir(&out).ok()?.filter_map(Result::ok).map(|entry| entry.path());
        entries.find(|path| !path.file_name().unwrap().to_str().unwrap().starts_with('.'))
    };
    let mut first = None;
    for _ in 0..1200 {
        first = whole();
        if first.is_some() || child.try_wait().unwrap().is_some() {
            break;
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let first = first.expect("a picture within a minute");
    let picture = image::open(first).expect("a whole picture, however early the tour ends");
    assert_eq!((picture.width(), picture.height()), (1280, 720));
}

#[test]
fn hostile_files_are_one_line_each() {
    let Some(models) = shared_models() else {
        println!("no ../shared/models here: skipped");
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let mut count = 0;
    for entry in std::fs::read_dir(models.join("hostile")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "gltf") {
            continue;
        }
        let (name, path) = (path.file_name().unwrap().to_str().unwrap().to_owned(), path.to_str().unwrap().to_owned());
        for arguments in [&["info", &path][..], &["render", &path, "--out", "a.png"]] {
            let message = bad(folder.path(), arguments);
            assert!(message.contains(&name), "{message}");
        }
        assert_eq!(names(folder.path()), Vec::<String>::new());
        count += 1;
    }
    assert!(count > 0);
}

#[test]
fn bench_measures_each_scene_by_each_technique() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let arguments = ["bench", "cubes", "shadowfun", "--technique", "none,z-fail", "--frames", "3", "--size", "64x36"];
    let json: Value = serde_json::from_str(&good(here, &[&arguments[..], &["--json"]].concat())).unwrap();
    let rows = json.as_array().unwrap();
    let of: Vec<_> = rows.iter().map(|row| (row["scene"].as_str().unwrap(), row["technique"].as_str().unwrap())).collect();
    assert_eq!(of, [("cubes", "none"), ("cubes", "z-fail"), ("shadowfun", "none"), ("shadowfun", "z-fail")]);
    for row in rows {
        let fields: Vec<_> = row.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(
            fields,
            // In the order of the alphabet, as the reader has them.
            [
                "cpu_ms",
                "fragments_per_pixel",
                "frame_ms",
                "frames",
                "gpu_ms",
                "height",
                "indices",
                "scene",
                "technique",
                "volume_triangles",
                "width"
            ]
        );
        assert_eq!((&row["width"], &row["height"], &row["frames"]), (&64.into(), &36.into(), &3.into()));
        for spread in ["frame_ms", "cpu_ms", "gpu_ms"].map(|name| &row[name]).into_iter().filter(|spread| !spread.is_null()) {
            let [p10, median, p90] = ["p10", "median", "p90"].map(|name| spread[name].as_f64().unwrap());
            assert!(0.0 <= p10 && p10 <= median && median <= p90 && p90 > 0.0, "{row}");
        }
        let volumes = row["technique"] == "z-fail";
        for count in ["fragments_per_pixel", "volume_triangles", "indices"] {
            assert_eq!(row[count].as_f64().unwrap() > 0.0, volumes, "{row}");
        }
    }
    let text = good(here, &["bench", "--failure", "dark-cap-fan", "--frames", "1", "--size", "64x36"]);
    assert!(text.contains("fragments a pixel") && text.lines().count() == 4, "{text}");
    for arguments in [
        &["bench", "cubes", "--technique", "auto,guess"][..],
        &["bench", "cubes", "--frames", "0"],
        &["bench", "cubes", "no-such-scene"],
        &["bench", "cubes", "--camera", "nobody"],
        &["bench", "cubes", "--size", "0x5"],
    ] {
        bad(here, arguments);
    }
    assert!(names(here).is_empty());
}

#[test]
fn bench_sweeps_write_a_table_and_a_plot() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let small = ["--frames", "1", "--size", "64x36"];
    for (sweep, columns) in [
        ("casters", "1,2,4"),
        ("triangles", "1024,2048,4096"),
        ("lights", "1,2,4"),
        ("bounces", "1,2,4"),
        ("pixels", "2304,4641,9216"),
    ] {
        let arguments = ["bench", "--sweep", sweep, "--out", "new/folder", "--steps", "3", "--technique", "none,auto"];
        let text = good(here, &[&arguments[..], &small].concat());
        assert!(text.contains("fragments a pixel") && text.lines().count() == 3 + 6, "{text}");
        let file = |ending: &str| here.join("new/folder").join(format!("{sweep}.{ending}"));
        let csv = std::fs::read_to_string(file("csv")).unwrap();
        let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let head = lines.next().unwrap();
        assert!(head.starts_with(&[sweep, "technique", "width", "height", "frames", "frame_ms"]), "{head:?}");
        let lines: Vec<_> = lines.collect();
        let of = |technique: &str| lines.iter().filter(|line| line[1] == technique).map(|line| line[0]).collect::<Vec<_>>();
        assert_eq!([of("none").join(","), of("auto").join(",")], [columns, columns], "{csv}");
        assert!(lines.iter().all(|line| line.len() == head.len()), "{csv}");
        image::open(file("png")).unwrap();
        let command = read_command(&file("png")).unwrap().unwrap();
        assert!(command.starts_with("obscura bench ") && command.contains(&format!("--sweep {sweep}")), "{command}");
        if sweep == "lights" {
            // It writes to where it is run.
            let words = shlex::split(&command).unwrap();
            good(here, &words.iter().skip(1).map(String::as_str).collect::<Vec<_>>());
            let again = std::fs::read_to_string(here.join("lights.csv")).unwrap();
            assert_eq!(again.lines().count(), csv.lines().count());
        }
    }
    std::fs::write(here.join("taken"), "").unwrap();
    let sweep = |words: &[&'static str]| [&["bench", "--sweep"][..], words, &small].concat();
    for words in [
        &["moons", "--out", "x"][..],
        &["casters", "cubes", "--out", "x"],
        &["bounces", "cubes", "gallery", "--out", "x"],
        &["pixels", "no-such-scene", "--out", "x"],
        &["lights", "--out", "taken"],
        &["lights", "--out", "x", "--steps", "99"],
    ] {
        bad(here, &sweep(words));
    }
    bad(here, &["bench", "--sweep", "pixels", "--out", "x", "--size", "8000x8000"]);
    assert_eq!(run(here, &sweep(&["lights"])).status.code(), Some(2), "where to?");
    assert_eq!(names(here), ["lights.csv", "lights.png", "new", "taken"]);
}

#[test]
fn verify_says_what_is_wrong_and_ends_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let text = good(here, &["verify", "cubes", "--size", "96x54", "--technique", "z-fail", "--diff", "d.png"]);
    assert!(text.contains("z-fail") && text.contains("lamp"), "{text}");
    assert_eq!(image::open(here.join("d.png")).unwrap().width(), 96);
    // Eyes in shadow: what z-pass claims is no more than it does, so its wrong pixels are no failure.
    let arguments = ["verify", "eye-in-shadow", "--size", "96x54", "--technique", "z-pass", "--random", "6", "--json"];
    let json: Value = serde_json::from_str(&good(here, &arguments)).unwrap();
    let rows = json["lights"].as_array().unwrap();
    assert!(rows.iter().all(|row| row["technique"] == "z-pass" && row["exact"] == false));
    assert!(rows.iter().map(|row| row["wrong"].as_u64().unwrap()).sum::<u64>() > 100, "{json}");
    assert!(json["wrong_views"][0]["command"].as_str().unwrap().starts_with("obscura render eye-in-shadow"));
    assert_eq!(json["seed"], 1);

    // A far plane spoils what is counted from infinity, and whoever asked for one is told so.
    let text = good(here, &["verify", "cubes", "--size", "96x54", "--technique", "z-fail", "--far", "18"]);
    assert!(text.contains("known to fail") && text.contains("no technique claims to be exact here: the far plane"), "{text}");

    let usage = run(here, &["verify", "cubes", "--show", "stencil"]);
    assert_eq!(usage.status.code(), Some(2));
    bad(here, &["verify", "cubes", "--technique", "guess"]);
    bad(here, &["verify", "cubes", "--light", "9"]);
    bad(here, &["verify", "cubes", "--diff", "nowhere/d.png"]);
}
