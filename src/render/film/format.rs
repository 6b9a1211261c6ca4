//! The formats of films, and the options of ffmpeg for each of them.

use std::ffi::OsString;
use std::path::Path;

use super::next_even;
use crate::render::Quality;
use crate::render::picture::Size;

/// The file format of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// H.264 video in an MP4 file.
    Mp4,
    /// VP9 video in a WebM file.
    Webm,
    /// An animated GIF that loops forever.
    Gif,
}

impl Format {
    /// All formats of films.
    pub const ALL: [Format; 3] = [Format::Mp4, Format::Webm, Format::Gif];

    /// Returns the file extension of the format, which is also ffmpeg's name for it.
    pub fn extension(self) -> &'static str {
        match self {
            Format::Mp4 => "mp4",
            Format::Webm => "webm",
            Format::Gif => "gif",
        }
    }

    /// Returns the format that belongs to the extension of a path. `None` for unknown extensions.
    pub(super) fn of(path: &Path) -> Option<Format> {
        let extension = path.extension()?;
        Format::ALL.into_iter().find(|format| extension.eq_ignore_ascii_case(format.extension()))
    }

    /// Returns ffmpeg's name of the encoder.
    pub fn encoder(self) -> &'static str {
        match self {
            Format::Mp4 => "libx264",
            Format::Webm => "libvpx-vp9",
            Format::Gif => "gif",
        }
    }

    /// Returns the indices of the images from which ffmpeg computes the palette of a GIF. ffmpeg receives these images first, and then all
    /// images. Other formats have no palette.
    ///
    /// For a palette of all images, ffmpeg would hold all of them in memory: 3.7 MB for each of 1280 × 720 pixels.
    pub(super) fn samples(self, images: usize) -> Vec<usize> {
        /// The largest number of images from which the palette is computed.
        const MAX_PALETTE_IMAGES: usize = 32;
        match self {
            Format::Gif => crate::render::contact_sheet::evenly(images, MAX_PALETTE_IMAGES),
            Format::Mp4 | Format::Webm => Vec::new(),
        }
    }

    /// Returns the arguments of ffmpeg for reading raw pixels from its standard input and making a film of this format. `samples` is the
    /// number of images for the palette.
    pub(super) fn arguments(
        self,
        (width, height): Size,
        rate: f64,
        samples: usize,
        quality: Quality,
    ) -> Vec<OsString> {
        let (pixels, width, height) = match self {
            // The documentation of the module `film` explains how transparency and odd sizes are handled.
            Format::Gif => ("rgba", width, height),
            Format::Mp4 | Format::Webm => ("rgb24", next_even(width), next_even(height)),
        };
        let mut words: Vec<String> = ["-f", "rawvideo", "-pixel_format", pixels].map(str::to_owned).into();
        words.extend(["-video_size".to_owned(), format!("{width}x{height}")]);
        words.extend(["-framerate".to_owned(), rate.to_string(), "-i".to_owned(), "pipe:0".to_owned()]);
        words.extend(["-filter_complex".to_owned(), self.filters(samples)]);
        words.extend(self.codec(quality).split(' ').map(str::to_owned));
        if self == Format::Mp4 {
            // A browser can then begin to play the film before it has loaded the whole file.
            words.extend(["-movflags", "+faststart"].map(str::to_owned));
        }
        if self != Format::Gif {
            // The number of threads is fixed, since the bytes of the film depend on it.
            let options = "-threads 8 -pix_fmt yuv420p \
                           -colorspace bt709 -color_primaries bt709 -color_trc bt709 -color_range tv";
            words.extend(options.split_whitespace().map(str::to_owned));
        }
        // ffmpeg must not write its version and the time into the file, so that equal films have equal bytes.
        words.extend(["-fflags", "+bitexact", "-flags:v", "+bitexact"].map(str::to_owned));
        words.extend(["-y", "-f", self.extension()].map(str::to_owned));
        words.into_iter().map(OsString::from).collect()
    }

    /// Returns the options of ffmpeg for the encoder and its quality. A lower number after `-crf` means a better picture.
    pub(in crate::render) fn codec(self, quality: Quality) -> &'static str {
        // The numbers for VP9 give about the same quality as those for H.264, measured by SSIM.
        match (self, quality) {
            (Format::Mp4, Quality::Draft) => "-c:v libx264 -preset veryfast -crf 28",
            // The film looks almost the same as the images.
            (Format::Mp4, Quality::Good) => "-c:v libx264 -preset medium -crf 18",
            // This quality is for films that will be cut and encoded again.
            (Format::Mp4, Quality::Final) => "-c:v libx264 -preset slow -crf 12",
            (Format::Webm, Quality::Draft) => {
                "-c:v libvpx-vp9 -crf 40 -b:v 0 -deadline good -cpu-used 5 -row-mt 1"
            }
            (Format::Webm, Quality::Good) => {
                "-c:v libvpx-vp9 -crf 24 -b:v 0 -deadline good -cpu-used 2 -row-mt 1"
            }
            (Format::Webm, Quality::Final) => {
                "-c:v libvpx-vp9 -crf 14 -b:v 0 -deadline good -cpu-used 1 -row-mt 1"
            }
            (Format::Gif, _) => "-c:v gif -loop 0",
        }
    }

    /// Returns the longest side of an image that the encoder accepts, pixels.
    pub(super) fn longest_side(self) -> u32 {
        match self {
            Format::Mp4 | Format::Webm => 16384,
            Format::Gif => 65535,
        }
    }

    /// Returns the ffmpeg filters between the images and the encoder: color conversion, and the palette of a GIF.
    fn filters(self, samples: usize) -> String {
        match self {
            Format::Mp4 | Format::Webm => {
                "scale=out_color_matrix=bt709:out_range=tv:flags=bicubic+accurate_rnd+full_chroma_int+full_chroma_inp,\
                 format=yuv420p,\
                 setparams=range=tv:color_primaries=bt709:color_trc=bt709:colorspace=bt709"
                    .to_owned()
            }
            // The dithering pattern of `bayer` stays in place from frame to frame, whereas error diffusion flickers. It also compresses
            // best.
            Format::Gif => format!(
                "split[first][rest];\
                 [first]trim=end_frame={samples},palettegen=stats_mode=full[palette];\
                 [rest]trim=start_frame={samples},setpts=PTS-STARTPTS[frames];\
                 [frames][palette]paletteuse=dither=bayer:bayer_scale=4"
            ),
        }
    }
}
