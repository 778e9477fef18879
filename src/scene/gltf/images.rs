//! PNG and JPEG, within limits; what cannot be decoded becomes a checker and a warning.
//!
//! A 480 KB PNG can say that it is 498 MB of pixels, so the size in the header is asked first, and
//! everything a file unpacks to comes out of one budget.

use std::collections::HashMap;
use std::io::Cursor;

use gltf::json::validation::Checked;
use gltf::json::{Root, texture};
use image::{ImageFormat, ImageReader, Limits};

use super::accessor::Store;
use super::error::{Budget, Warnings, clip, part};
use super::files::Folder;
use crate::scene::{Texture, Wrap};

/// Pixels a side.
const LARGEST_SIDE: u32 = 8192;
/// Bytes one image may unpack to.
const LARGEST_IMAGE: u64 = 256 << 20;
/// A progressive JPEG is held as coefficients too, which the decoder's own limit does not count.
const LARGEST_JPEG_PIXELS: u64 = 32 << 20;
/// Bytes all images of a file may unpack to.
const ALL_IMAGES: u64 = 768 << 20;

/// The images of a file, decoded when a material needs them.
pub(super) struct Images<'a> {
    root: &'a Root,
    store: &'a Store<'a>,
    folder: &'a Folder,
    budget: Budget,
    /// By image and sampling.
    known: HashMap<(usize, [Wrap; 2], bool), usize>,
    /// The scene's.
    pub textures: Vec<Texture>,
}

impl<'a> Images<'a> {
    pub fn new(root: &'a Root, store: &'a Store<'a>, folder: &'a Folder) -> Self {
        Self { root, store, folder, budget: Budget::new(ALL_IMAGES), known: HashMap::new(), textures: Vec::new() }
    }

    /// The scene's texture for one of the file's; a checker where there is no image to be had.
    pub fn texture(&mut self, index: usize, warnings: &mut Warnings) -> Option<usize> {
        let texture = self.root.textures.get(index)?;
        let sampler = texture.sampler.and_then(|sampler| self.root.samplers.get(sampler.value()));
        let wrap = |mode: &Checked<texture::WrappingMode>| match mode {
            Checked::Valid(texture::WrappingMode::ClampToEdge) => Wrap::Clamp,
            Checked::Valid(texture::WrappingMode::MirroredRepeat) => Wrap::Mirror,
            _ => Wrap::Repeat,
        };
        let wrap = sampler.map_or([Wrap::Repeat; 2], |sampler| [wrap(&sampler.wrap_s), wrap(&sampler.wrap_t)]);
        let nearest = sampler.is_some_and(|sampler| sampler.mag_filter == Some(Checked::Valid(texture::MagFilter::Nearest)));
        let image = texture.source.value();
        if let Some(known) = self.known.get(&(image, wrap, nearest)) {
            return Some(*known);
        }
        let name = self.root.images.get(image).and_then(|image| image.name.clone()).filter(|name| !name.is_empty());
        let decoded = self.find(image).and_then(|bytes| decode(&bytes, &self.budget));
        let (width, height, rgba) = decoded.unwrap_or_else(|reason| {
            let shown = part("image", image, name.as_deref());
            let shown = if image == u32::MAX as usize { part("texture", index, texture.name.as_deref()) } else { shown };
            warnings.push(format!("{shown}: {reason}; a checker stands in for it"));
            placeholder()
        });
        self.textures.push(Texture {
            name: super::error::name("image", if image == u32::MAX as usize { index } else { image }, name.as_deref()),
            width,
            height,
            rgba,
            wrap,
            nearest,
        });
        self.known.insert((image, wrap, nearest), self.textures.len() - 1);
        Some(self.textures.len() - 1)
    }

    /// The file that an image is.
    fn find(&self, index: usize) -> Result<Vec<u8>, String> {
        let Some(image) = self.root.images.get(index) else { return Err("it has no image that can be shown".into()) };
        match (&image.uri, image.buffer_view) {
            (Some(uri), _) => self.folder.resolve(uri),
            (None, Some(view)) => self.store.view(view.value()).map(<[u8]>::to_vec).map_err(|error| error.to_string()),
            (None, None) => Err("it has neither a URI nor a buffer view".into()),
        }
    }
}

fn decode(bytes: &[u8], budget: &Budget) -> Result<(u32, u32, Vec<u8>), String> {
    let reader = || ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| error.to_string());
    let format = reader()?.format();
    if !matches!(format, Some(ImageFormat::Png | ImageFormat::Jpeg)) {
        return Err("it is neither PNG nor JPEG".into());
    }
    let told = |error: image::ImageError| clip(&super::error::one_line(&error.to_string()));
    let (width, height) = reader()?.into_dimensions().map_err(told)?;
    let pixels = u64::from(width) * u64::from(height);
    let most = if format == Some(ImageFormat::Jpeg) { LARGEST_JPEG_PIXELS } else { LARGEST_IMAGE / 4 };
    if width > LARGEST_SIDE || height > LARGEST_SIDE || pixels > most {
        return Err(format!("{width} x {height} pixels are too many"));
    }
    if !budget.take(Some(pixels * 4)) {
        return Err(format!("the file's images are more than {} MiB", ALL_IMAGES >> 20));
    }
    let mut limits = Limits::no_limits();
    limits.max_image_width = Some(LARGEST_SIDE);
    limits.max_image_height = Some(LARGEST_SIDE);
    limits.max_alloc = Some(LARGEST_IMAGE);
    let mut reader = reader()?;
    reader.limits(limits);
    let rgba = reader.decode().map_err(told)?.into_rgba8();
    if rgba.width() == 0 || rgba.height() == 0 {
        return Err("it has no pixels".into());
    }
    Ok((rgba.width(), rgba.height(), rgba.into_raw()))
}

/// Magenta and grey: plainly no texture of the file's.
fn placeholder() -> (u32, u32, Vec<u8>) {
    const SIDE: u32 = 16;
    let pixel =
        |at: u32| if (at % SIDE / 4 + at / SIDE / 4).is_multiple_of(2) { [200, 60, 200, 255] } else { [110, 110, 110, 255] };
    (SIDE, SIDE, (0..SIDE * SIDE).flat_map(pixel).collect())
}
