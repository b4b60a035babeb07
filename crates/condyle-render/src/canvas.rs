//! A picture of pixels: others are placed in it, text is written, and it becomes a PNG.

use crate::palette::Colour;
use embedded_graphics::mono_font::{MonoFont, MonoTextStyle, iso_8859_1};
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::{
    DrawTarget, Drawable, OriginDimensions, Pixel, Point, RgbColor, Size,
};
use embedded_graphics::text::{Baseline, Text};
use std::convert::Infallible;

/// Pixels in rows from the top, each sRGB.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<Colour>,
}

impl Canvas {
    /// A canvas of one colour.
    pub fn new(width: usize, height: usize, colour: Colour) -> Self {
        Self { width, height, pixels: vec![colour; width * height] }
    }

    /// A canvas of given pixels, rows from the top; what is missing is black.
    pub fn of_pixels(width: usize, height: usize, mut pixels: Vec<Colour>) -> Self {
        pixels.resize(width * height, [0; 3]);
        Self { width, height, pixels }
    }

    /// Its width in pixels.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Its height in pixels.
    pub fn height(&self) -> usize {
        self.height
    }

    /// All pixels, rows from the top.
    pub fn pixels(&self) -> &[Colour] {
        &self.pixels
    }

    /// The colour at a place; `None` outside.
    pub fn at(&self, x: usize, y: usize) -> Option<Colour> {
        (x < self.width && y < self.height).then(|| self.pixels[y * self.width + x])
    }

    /// Covers a place with another canvas, as far as it fits.
    pub fn place(&mut self, other: &Self, x: usize, y: usize) {
        let wide = other.width.min(self.width.saturating_sub(x));
        for row in 0..other.height.min(self.height.saturating_sub(y)) {
            let to = (y + row) * self.width + x;
            let from = row * other.width;
            self.pixels[to..to + wide].copy_from_slice(&other.pixels[from..from + wide]);
        }
    }

    /// Mixes a colour into a pixel; nothing outside.
    pub(crate) fn mix(&mut self, x: i64, y: i64, colour: Colour, opacity: f64) {
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { return };
        if x < self.width && y < self.height {
            let pixel = &mut self.pixels[y * self.width + x];
            for (old, new) in pixel.iter_mut().zip(colour) {
                let mixed = f64::from(*old) * (1.0 - opacity) + f64::from(new) * opacity;
                *old = mixed.round() as u8;
            }
        }
    }

    /// Writes one line of text with its upper left corner at a place, over a halo of another colour so
    /// that it can be read on anything. Characters beyond Latin-1 become `?`.
    pub fn write(
        &mut self,
        text: &str,
        at: (i32, i32),
        size: TextSize,
        colour: Colour,
        halo: Colour,
    ) {
        for (dx, dy) in [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)] {
            self.stroke(text, (at.0.saturating_add(dx), at.1.saturating_add(dy)), size, halo);
        }
        self.stroke(text, at, size, colour);
    }

    fn stroke(&mut self, text: &str, at: (i32, i32), size: TextSize, [r, g, b]: Colour) {
        let style = MonoTextStyle::new(size.font(), Rgb888::new(r, g, b));
        let text = Text::with_baseline(text, Point::new(at.0, at.1), style, Baseline::Top);
        let Ok(_) = text.draw(self);
    }

    /// The bytes of a PNG file; empty if the canvas is.
    pub fn png(&self) -> Vec<u8> {
        let mut bytes = vec![];
        let (Ok(width), Ok(height)) = (u32::try_from(self.width), u32::try_from(self.height))
        else {
            return bytes;
        };
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Balanced);
        let written = encoder
            .write_header()
            .and_then(|mut writer| writer.write_image_data(self.pixels.as_flattened()));
        if written.is_err() {
            bytes.clear();
        }
        bytes
    }
}

impl OriginDimensions for Canvas {
    fn size(&self) -> Size {
        let whole = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
        Size::new(whole(self.width), whole(self.height))
    }
}

impl DrawTarget for Canvas {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(
        &mut self,
        pixels: I,
    ) -> Result<(), Infallible> {
        for Pixel(at, colour) in pixels {
            let colour = [colour.r(), colour.g(), colour.b()];
            self.mix(at.x.into(), at.y.into(), colour, 1.0);
        }
        Ok(())
    }
}

/// How large text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum TextSize {
    /// 5 by 8 pixels a character.
    Small,
    /// 7 by 13.
    Medium,
    /// 10 by 20.
    Large,
}

impl TextSize {
    /// What suits a picture of so many pixels.
    pub fn for_picture(width: usize, height: usize) -> Self {
        match width.min(height) {
            0..=299 => Self::Small,
            300..=1399 => Self::Medium,
            _ => Self::Large,
        }
    }

    fn font(self) -> &'static MonoFont<'static> {
        match self {
            Self::Small => &iso_8859_1::FONT_5X8,
            Self::Medium => &iso_8859_1::FONT_7X13,
            Self::Large => &iso_8859_1::FONT_10X20,
        }
    }

    /// Width and height of one character in pixels.
    pub fn character(self) -> (usize, usize) {
        let size = self.font().character_size;
        (size.width as usize, size.height as usize)
    }
}
