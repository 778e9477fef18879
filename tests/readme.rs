//! The README names everything there is, and nothing that is not there.
#![allow(clippy::unwrap_used, clippy::panic)] // a test may stop where it stands

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use obscura::app::keys;
use obscura::failures;
use obscura::headless::catalog::Catalog;
use obscura::headless::{plot, read_command};

const README: &str = include_str!("../README.md");

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn every_key_is_listed_and_no_other() {
    let section = README.split("\n## Keys\n").nth(1).unwrap().split("\n## ").next().unwrap();
    let listed: Vec<_> = section.lines().filter(|line| line.starts_with("| ")).skip(2).collect();
    let expected: Vec<_> = keys::TABLE.iter().map(|row| format!("| {} | {} |", row.keys, row.about)).collect();
    assert_eq!(listed, expected, "README.md, Keys; the right lines are:\n{}\n", expected.join("\n"));
}

#[test]
fn every_failure_is_listed_as_the_gallery_has_it() {
    let section = README.split("\n## The failure gallery\n").nth(1).unwrap().split("\n## ").next().unwrap();
    let listed: Vec<_> = section.lines().filter(|line| line.starts_with("| `")).collect();
    let line = |row: &failures::Row| {
        format!("| `{}` | {} | {} | {} | {} |", row.failure.name(), row.seen, row.why, row.cure, row.source)
    };
    let expected: Vec<_> = failures::TABLE.iter().map(line).collect();
    assert_eq!(listed, expected, "README.md; the right lines are:\n{}\n", expected.join("\n"));
}

#[test]
fn every_scene_technique_and_show_is_named() {
    let catalog = Catalog::new();
    for entry in &catalog.scenes {
        assert!(README.contains(&format!("`{}`", entry.name)), "scene {}", entry.name);
    }
    for entry in &catalog.techniques {
        assert!(README.contains(&format!("\n| `{}` | ", entry.name)), "technique {}", entry.name);
    }
    for entry in &catalog.shows {
        assert!(README.contains(&format!("\n| `{}` | ", entry.name)), "show {}", entry.name);
    }
}

/// The `--words` of a text.
fn options(text: &str) -> BTreeSet<String> {
    let words = text.split(|letter: char| !(letter.is_ascii_alphanumeric() || letter == '-'));
    words.filter(|word| word.len() > 3 && word.starts_with("--") && !word.starts_with("---")).map(str::to_owned).collect()
}

#[test]
fn every_option_is_listed_and_no_other() {
    let mut there = BTreeSet::new();
    for command in [
        &["--help"][..],
        &["render", "--help"],
        &["list", "--help"],
        &["info", "--help"],
        &["tour", "--help"],
        &["figures", "--help"],
        &["verify", "--help"],
        &["bench", "--help"],
        &["playground", "--help"],
    ] {
        let output = Command::new(env!("CARGO_BIN_EXE_obscura")).args(command).output().unwrap();
        there.extend(options(&String::from_utf8(output.stdout).unwrap()));
    }
    for ours in ["--help", "--version"] {
        assert!(there.remove(ours), "{ours}");
    }
    let section = README.split("\n## Command line\n").nth(1).unwrap().split("\n## ").next().unwrap();
    assert_eq!(options(section), there);
}

#[test]
fn every_picture_is_there_small_and_drawn_by_the_program() {
    let (mut total, mut plots) = (0, 0);
    let links: Vec<_> = README.split("](").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    for link in links.into_iter().filter(|link| !link.starts_with("http")) {
        let path = root().join(link);
        assert!(path.is_file(), "{link} is not there");
        if link.ends_with(".png") {
            let command = read_command(&path).unwrap().unwrap();
            let size = image::image_dimensions(&path).unwrap();
            // Pictures are two in a row, or three.
            let (sizes, sum) = match command.split(' ').nth(1) {
                Some("render") => ([(640, 360), (480, 270)], &mut total),
                Some("bench") => ([plot::SIZE.into(); 2], &mut plots),
                _ => panic!("{link}: {command}"),
            };
            assert!(sizes.contains(&size), "{link}");
            *sum += path.metadata().unwrap().len();
        }
    }
    assert!(total > 0 && total < 2_200_000, "{total} bytes of pictures");
    assert!(plots > 0 && plots < 300_000, "{plots} bytes of plots");
}
