//! Tests of the properties of GIF films: they loop, their delays are multiples of 1/100 s, and they may be transparent.

use std::fs;

use jabuka::render::Film;
use png::ColorType;

use super::images::{sequence, write};
use super::probe::{durations, make, pixels, stream};

#[test]
fn it_loops_for_ever() {
    let folder = tempfile::tempdir().unwrap();
    let film = folder.path().join("film.gif");
    make(&film, &sequence(folder.path(), 3, (32, 32)), 25.0);
    let bytes = fs::read(&film).unwrap();
    let at = bytes.windows(11).position(|name| name == b"NETSCAPE2.0").expect("a loop");
    assert_eq!(bytes[at + 11..at + 16], [3, 1, 0, 0, 0], "no end");
}

#[test]
fn delays_add_up_and_none_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let film = folder.path().join("film.gif");
    // Use more images than the palette is made from.
    let images = sequence(folder.path(), 60, (32, 32));
    for (rate, kinds, sum) in [
        (25.0, vec![4], 240),
        (50.0, vec![2], 120),
        (24.0, vec![4, 5], 250),
        (30.0, vec![3, 4], 200),
        (60.0, vec![2], 120),
        (240.0, vec![2], 120),
        (0.5, vec![200], 12_000),
    ] {
        make(&film, &images, rate);
        assert_eq!(stream(&film, "nb_read_frames"), "nb_read_frames=60", "{rate}");
        let delays = delays(&fs::read(&film).unwrap());
        assert_eq!(delays.len(), 60, "{rate}");
        assert!(delays.iter().all(|delay| kinds.contains(delay)), "{rate}: {delays:?}");
        let total: u32 = delays.iter().map(|delay| u32::from(*delay)).sum();
        assert!(total.abs_diff(sum) <= 1, "{rate}: {total}");
        assert_eq!(durations(&film).len(), 60);
        let shown = Film::new(&film).unwrap().shown_rate(rate);
        assert!((60.0 / shown * 100.0 - f64::from(total)).abs() <= 1.0, "{rate}: {shown}");
    }
}

#[test]
fn what_is_transparent_stays_so_and_leaves_no_trace() {
    let folder = tempfile::tempdir().unwrap();
    let film = folder.path().join("film.gif");
    // The images show a square of 4 × 4 pixels that moves.
    let images: Vec<_> = (0..6)
        .map(|index| {
            let path = folder.path().join(format!("{index}.png"));
            let inside = |i: usize| (4 * index..4 * index + 4).contains(&(i % 32)) && (i / 32) < 4;
            let pixel = |i| if inside(i) { [200, 30, 30, 255] } else { [0, 0, 0, 0] };
            write(&path, (32, 8), ColorType::Rgba, &(0..32 * 8).flat_map(pixel).collect::<Vec<u8>>());
            path
        })
        .collect();
    make(&film, &images, 25.0);
    let pixels = pixels(&film, "rgba");
    assert_eq!(pixels.len(), 6 * 32 * 8 * 4);
    for (index, frame) in pixels.chunks(32 * 8 * 4).enumerate() {
        let opaque: Vec<usize> = (0..256).filter(|i| frame[4 * i + 3] == 255).collect();
        assert_eq!(opaque.len(), 16, "frame {index}: {opaque:?}");
        assert!(opaque.iter().all(|i| i % 32 / 4 == index), "frame {index}: {opaque:?}");
    }
}

/// Returns the delays of a GIF's frames in 1/100 s, from its graphic control extensions.
fn delays(bytes: &[u8]) -> Vec<u16> {
    let is_extension = |eight: &&[u8]| eight[..3] == [0x21, 0xf9, 4] && eight[7] == 0;
    let delay = |eight: &[u8]| u16::from_le_bytes([eight[4], eight[5]]);
    bytes.windows(8).filter(is_extension).map(delay).collect()
}
