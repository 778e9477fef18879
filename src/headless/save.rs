//! Pictures to disk: PNG, with the command that draws them again, all or nothing.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use image::RgbaImage;
use thiserror::Error;

/// The keyword of the PNG text chunk that holds the `obscura render` line.
pub const COMMAND_KEY: &str = "obscura-command";

/// Why a picture was not written. The file then is as it was before.
#[derive(Debug, Error)]
pub enum SaveError {
    /// The folder to write to is missing.
    #[error("cannot write {}: there is no folder {}", .0.display(), .1.display())]
    NoFolder(PathBuf, PathBuf),
    /// A folder, a device: nothing that a picture may replace.
    #[error("cannot write {}: it is there already and is not a file", .0.display())]
    NotAFile(PathBuf),
    /// A name that promises another format, or none.
    #[error("cannot write {}: pictures are PNG, so the name must end in .png", .0.display())]
    NotPng(PathBuf),
    /// The system said no.
    #[error("cannot write {path}: {error}", path = .0.display(), error = .1)]
    Io(PathBuf, #[source] std::io::Error),
    /// The picture cannot be a PNG.
    #[error("cannot write {path}: {error}", path = .0.display(), error = .1)]
    Encode(PathBuf, #[source] png::EncodingError),
}

/// Says whether a picture could be written to `path`, before the work of drawing it.
///
/// # Errors
/// What [`save_png`] would say, as far as it can be known.
pub fn check_target(path: &Path) -> Result<(), SaveError> {
    if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
        return Err(SaveError::NotPng(path.into()));
    }
    let folder = folder_of(path);
    if !folder.is_dir() {
        return Err(SaveError::NoFolder(path.into(), folder.into()));
    }
    match path.metadata() {
        Ok(there) if !there.is_file() => Err(SaveError::NotAFile(path.into())),
        _ => Ok(()),
    }
}

/// Writes `image` (sRGB) as a PNG whose text says `command`: whole to a temporary name beside
/// `path`, then renamed, so nobody ever sees half a picture.
///
/// # Errors
/// Nothing is left behind then.
pub fn save_png(path: &Path, image: &RgbaImage, command: &str) -> Result<(), SaveError> {
    check_target(path)?;
    let bytes = encode(image, command).map_err(|error| SaveError::Encode(path.into(), error))?;
    save_bytes(path, &bytes)
}

/// Writes a file whole, to a temporary name beside `path`, which is then renamed.
///
/// # Errors
/// Nothing is left behind then.
pub fn save_bytes(path: &Path, bytes: &[u8]) -> Result<(), SaveError> {
    let io = |error| SaveError::Io(path.into(), error);
    let mut builder = tempfile::Builder::new();
    builder.prefix(".obscura-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // What any new file gets; the system takes the umask off.
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder_of(path)).map_err(io)?;
    file.write_all(bytes).map_err(io)?;
    file.persist(path).map_err(|error| io(error.error))?;
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

/// The bytes of a PNG. The same picture and command give the same bytes.
fn encode(image: &RgbaImage, command: &str) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, image.width(), image.height());
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    // tEXt is Latin-1, which every viewer shows; other paths need iTXt.
    if command.chars().all(|letter| letter as u32 <= 0xff) {
        encoder.add_text_chunk(COMMAND_KEY.into(), command.into())?;
    } else {
        encoder.add_itxt_chunk(COMMAND_KEY.into(), command.into())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(image.as_raw())?;
    writer.finish()?;
    Ok(bytes)
}

/// The command that a picture of this program carries, if it does.
///
/// # Errors
/// A file that cannot be read as PNG.
pub fn read_command(path: &Path) -> Result<Option<String>, Box<dyn std::error::Error + Send + Sync>> {
    let mut reader = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path)?)).read_info()?;
    reader.finish()?;
    let info = reader.info();
    if let Some(chunk) = info.uncompressed_latin1_text.iter().find(|chunk| chunk.keyword == COMMAND_KEY) {
        return Ok(Some(chunk.text.clone()));
    }
    let chunk = info.utf8_text.iter().find(|chunk| chunk.keyword == COMMAND_KEY);
    Ok(chunk.map(png::text_metadata::ITXtChunk::get_text).transpose()?)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test may stop where it stands

    use super::*;

    fn picture() -> RgbaImage {
        RgbaImage::from_fn(5, 3, |x, y| image::Rgba([x as u8 * 40, y as u8 * 80, 7, 255]))
    }

    fn names(folder: &Path) -> Vec<String> {
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn the_picture_and_its_command_come_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        for command in ["obscura render cubes --out a.png", "obscura render Füchse.glb", "obscura render 狐.glb"] {
            save_png(&path, &picture(), command).unwrap();
            assert_eq!(image::open(&path).unwrap().to_rgba8(), picture());
            assert_eq!(read_command(&path).unwrap().unwrap(), command);
        }
        assert_eq!(names(folder.path()), ["a.png"]);
    }

    #[test]
    fn the_same_picture_is_the_same_bytes() {
        assert_eq!(encode(&picture(), "x").unwrap(), encode(&picture(), "x").unwrap());
    }

    #[cfg(unix)]
    #[test]
    fn others_may_read_the_picture_as_they_may_any_new_file() {
        use std::os::unix::fs::PermissionsExt as _;
        let folder = tempfile::tempdir().unwrap();
        let (path, plain) = (folder.path().join("a.png"), folder.path().join("plain"));
        save_png(&path, &picture(), "x").unwrap();
        std::fs::write(&plain, "").unwrap();
        let mode = |path: &Path| path.metadata().unwrap().permissions().mode();
        assert_eq!(mode(&path), mode(&plain));
    }

    #[test]
    fn what_cannot_be_written_leaves_nothing_and_says_where() {
        let folder = tempfile::tempdir().unwrap();
        let missing = folder.path().join("nowhere/a.png");
        let message = save_png(&missing, &picture(), "x").unwrap_err().to_string();
        assert!(message.contains("there is no folder") && message.contains("nowhere"), "{message}");
        let taken = folder.path().join("folder.png");
        std::fs::create_dir(&taken).unwrap();
        assert!(matches!(save_png(&taken, &picture(), "x"), Err(SaveError::NotAFile(_))));
        assert!(matches!(save_png(&folder.path().join("a.jpg"), &picture(), "x"), Err(SaveError::NotPng(_))));
        assert_eq!(names(folder.path()), ["folder.png"]);
    }

    #[test]
    fn a_bare_file_name_stands_in_this_folder() {
        assert_eq!(folder_of(Path::new("a.png")), Path::new("."));
        assert_eq!(folder_of(Path::new("b/a.png")), Path::new("b"));
    }
}
