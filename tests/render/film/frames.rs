//! Tests of a film's frames: one for each image, in the right order and at the right rate.

use std::cell::Cell;
use std::fs;

use jabuka::render::{Film, Pace};

use super::images::{plain, sequence};
use super::probe::{confined, make, pixels, stream};

#[test]
fn every_rate_keeps_every_frame() {
    let folder = tempfile::tempdir().unwrap();
    let images = sequence(folder.path(), 50, (64, 48));
    for extension in ["mp4", "webm"] {
        for (rate, exact) in
            [(23.976, "2997/125"), (29.97, "2997/100"), (0.5, "1/2"), (60.0, "60/1"), (120.0, "120/1")]
        {
            let film = folder.path().join(format!("film at {rate}.{extension}"));
            make(&film, &images, rate);
            assert_eq!(stream(&film, "nb_read_frames"), "nb_read_frames=50", "{}", film.display());
            if extension == "mp4" {
                assert_eq!(stream(&film, "r_frame_rate"), format!("r_frame_rate={exact}"));
                assert_eq!(stream(&film, "avg_frame_rate"), format!("avg_frame_rate={exact}"));
            }
        }
    }
}

#[test]
fn the_ends_of_what_rates_there_are_work() {
    let folder = tempfile::tempdir().unwrap();
    let images = sequence(folder.path(), 5, (32, 32));
    for rate in [*Pace::RATES.start(), *Pace::RATES.end()] {
        for extension in ["mp4", "webm", "gif"] {
            let film = folder.path().join(format!("film.{extension}"));
            make(&film, &images, rate);
            assert_eq!(stream(&film, "nb_read_frames"), "nb_read_frames=5", "{rate} {extension}");
        }
    }
}

#[test]
fn the_streams_are_what_plays_everywhere() {
    let folder = tempfile::tempdir().unwrap();
    let images = sequence(folder.path(), 3, (64, 48));
    let fields = "codec_name,pix_fmt,width,height,color_range,color_space,color_transfer,color_primaries";
    for (extension, codec) in [("mp4", "h264"), ("webm", "vp9")] {
        let film = folder.path().join("film").with_extension(extension);
        make(&film, &images, 25.0);
        let expected = format!(
            "codec_name={codec} width=64 height=48 pix_fmt=yuv420p \
             color_range=tv color_space=bt709 color_transfer=bt709 color_primaries=bt709"
        );
        assert_eq!(stream(&film, fields), expected);
    }
    // The index `moov` comes before the pictures, so a browser can start to play before it has loaded the whole file.
    let bytes = fs::read(folder.path().join("film.mp4")).unwrap();
    let place = |name: &[u8]| bytes.windows(4).position(|four| four == name).unwrap();
    assert!(place(b"moov") < place(b"mdat"));
}

#[test]
fn one_image_makes_a_film() {
    let folder = tempfile::tempdir().unwrap();
    let images = sequence(folder.path(), 1, (64, 48));
    for extension in ["mp4", "webm", "gif"] {
        let film = folder.path().join("film").with_extension(extension);
        make(&film, &images, 25.0);
        assert_eq!(stream(&film, "nb_read_frames"), "nb_read_frames=1", "{extension}");
    }
}

#[test]
fn the_frames_come_in_the_order_of_the_list() {
    let folder = tempfile::tempdir().unwrap();
    let gray = |name: &str, value: u8| {
        let path = folder.path().join(name);
        plain(&path, (16, 16), [value; 3]);
        path
    };
    let images = [gray("z.png", 20), gray("a.png", 220), gray("frame_0007.png", 120), gray("-y %d.png", 60)];
    for extension in ["mp4", "webm", "gif"] {
        let film = folder.path().join("film").with_extension(extension);
        make(&film, &images, 10.0);
        let pixels = pixels(&film, "rgb24");
        let seen: Vec<u8> = pixels.chunks(16 * 16 * 3).map(|frame| frame[400]).collect();
        let near = |(a, b): (&u8, &u8)| a.abs_diff(*b) <= 4;
        assert!(seen.len() == 4 && seen.iter().zip(&[20, 220, 120, 60]).all(near), "{extension}: {seen:?}");
    }
}

#[test]
fn an_odd_size_is_made_even_by_a_copy_of_the_edge_and_not_by_a_black_line() {
    let folder = tempfile::tempdir().unwrap();
    let image = folder.path().join("white.png");
    plain(&image, (33, 19), [255; 3]);
    for extension in ["mp4", "webm"] {
        let film = folder.path().join("film").with_extension(extension);
        make(&film, &vec![image.clone(); 3], 25.0);
        assert_eq!(stream(&film, "width,height"), "width=34 height=20");
        let darkest = pixels(&film, "rgb24").into_iter().min();
        assert!(darkest >= Some(250), "{extension}: {darkest:?}");
    }
    let film = folder.path().join("film.gif");
    make(&film, &vec![image.clone(); 3], 25.0);
    assert_eq!(stream(&film, "width,height"), "width=33 height=19");
    let dot = folder.path().join("dot.png");
    plain(&dot, (1, 1), [255; 3]);
    for extension in ["mp4", "webm", "gif"] {
        make(&folder.path().join("dot").with_extension(extension), std::slice::from_ref(&dot), 25.0);
    }
}

#[test]
fn the_same_images_give_the_same_bytes_under_any_name() {
    let folder = tempfile::tempdir().unwrap();
    let images = sequence(folder.path(), 20, (128, 96));
    for extension in ["mp4", "webm", "gif"] {
        let films = ["one", "other"].map(|name| folder.path().join(name).with_extension(extension));
        for film in &films {
            make(film, &images, 25.0);
        }
        let [one, other] = films.map(|film| fs::read(film).unwrap());
        assert!(one == other, "{extension}");
    }
}

#[test]
fn progress_goes_up_to_the_number_of_images() {
    let folder = tempfile::tempdir().unwrap();
    let images = sequence(folder.path(), 30, (64, 48));
    let film = Film::new(folder.path().join("new folder/film.mp4")).unwrap();
    let ffmpeg = film.check(None, confined()).unwrap();
    let last = Cell::new(0);
    let progress = |frames| {
        assert!(frames > last.get());
        last.set(frames);
    };
    film.make(&images, 25.0, &ffmpeg, &|| false, &progress).unwrap();
    assert_eq!(last.get(), 30);
}
