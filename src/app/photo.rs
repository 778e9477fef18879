//! Saving the picture: where, and under what name.

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use crate::headless::{SaveError, save_png};
use crate::settings::{SceneChoice, Settings};

/// Saves `image` with the command that draws it again, in the current folder or, where that takes
/// no files, among the user's pictures. Says where.
///
/// # Errors
/// No folder takes it.
pub fn save(image: &image::RgbaImage, settings: &Settings, command: &str) -> Result<PathBuf, SaveError> {
    let name = name(settings, SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default());
    let here = std::env::current_dir().unwrap_or_else(|_| PathBuf::from("."));
    let path = free(&here, &name);
    match (save_png(&path, image, command), dirs::picture_dir()) {
        (Ok(()), _) => Ok(path),
        (Err(_), Some(pictures)) => {
            let path = free(&pictures, &name);
            save_png(&path, image, command).map(|()| path)
        }
        (Err(error), None) => Err(error),
    }
}

/// `obscura-courtyard-auto-20261122-142530`: scene, technique, and the time in UTC.
fn name(settings: &Settings, since_epoch: Duration) -> String {
    let scene = match &settings.scene {
        SceneChoice::Stock(name) => name.clone(),
        SceneChoice::File(path) => path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
    };
    let plain = |letter: char| if letter.is_alphanumeric() || "-_".contains(letter) { letter } else { '_' };
    let scene: String = scene.chars().map(plain).take(40).collect();
    let seconds = since_epoch.as_secs();
    let (year, month, day) = date(seconds / 86_400);
    let (hour, minute, second) = (seconds / 3600 % 24, seconds / 60 % 60, seconds % 60);
    format!("obscura-{scene}-{}-{year:04}{month:02}{day:02}-{hour:02}{minute:02}{second:02}", settings.technique.name())
}

/// Year, month and day, so many days after 1970-01-01, in the Gregorian calendar.
fn date(days: u64) -> (u64, u64, u64) {
    let leap = |year: u64| (year.is_multiple_of(4) && !year.is_multiple_of(100)) || year.is_multiple_of(400);
    let (mut year, mut left) = (1970, days);
    while left >= 365 + u64::from(leap(year)) {
        left -= 365 + u64::from(leap(year));
        year += 1;
    }
    let february = 28 + u64::from(leap(year));
    for (month, length) in (1..).zip([31, february, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31]) {
        if left < length {
            return (year, month, left + 1);
        }
        left -= length;
    }
    (year, 12, 31)
}

/// A file of this name that is not there yet: two pictures a second are two files.
fn free(folder: &Path, name: &str) -> PathBuf {
    let numbered = (2..1000).map(|number| folder.join(format!("{name}-{number}.png")));
    let first = folder.join(format!("{name}.png"));
    std::iter::once(first.clone()).chain(numbered).find(|path| !path.exists()).unwrap_or(first)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a failed unwrap is a failed test
    use super::*;

    #[test]
    fn names_say_what_and_when() {
        let settings = Settings { scene: SceneChoice::File("/a/my scene\n.glb".into()), ..Settings::default() };
        // 2024-02-29 12:34:56 UTC, by `date -u -d @1709210096`.
        assert_eq!(name(&settings, Duration::from_secs(1_709_210_096)), "obscura-my_scene_-auto-20240229-123456");
        assert_eq!(date(0), (1970, 1, 1));
        assert_eq!(date(11_016), (2000, 2, 29));
        assert_eq!(date(47_540), (2100, 2, 28));
        assert_eq!(date(47_541), (2100, 3, 1));
    }

    #[test]
    fn no_picture_replaces_another() {
        let folder = tempfile::tempdir().unwrap();
        let first = free(folder.path(), "a");
        std::fs::write(&first, "x").unwrap();
        let second = free(folder.path(), "a");
        assert_ne!(first, second);
        assert!(second.ends_with("a-2.png"));
    }
}
