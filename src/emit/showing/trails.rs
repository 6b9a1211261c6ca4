//! Writes the trails of bodies in SDL.
//!
//! The points of a trail are an array, and the macro `Trail` draws the array. If the color of a trail follows a value, a second array has the
//! number of each point's color, and the macro `Shaded_trail` draws both: a piece has the color of its end. In the layout `shared`, each finished stretch of a trail is
//! a separate file. A script then contains only the remaining part of the trail, and does not repeat the whole path of a body. The name of
//! a file contains the digest of its text, so the text of a file never changes.

use std::collections::HashMap;
use std::sync::Arc;
use std::sync::{Mutex, PoisonError};

use glam::DVec3;

use super::super::{sdl::Style, text};
use super::color;
use crate::picture::{Plan, Stretch, Trail};
use crate::scene::Layout;
use crate::simulate::Frame;
use sha2::{Digest, Sha256};

/// An include file with a stretch of a trail. Several scripts include it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrailFile {
    /// The file name, which contains a digest of the text: `trail_5f0c1a2b3c4d5e6f.inc`.
    pub name: String,
    /// The SDL text of the file.
    pub text: String,
}

/// Writes the trails of a scene in SDL.
pub(super) struct Trails {
    layout: Layout,
    style: Style,
    /// The digests of all stretches written so far, by index of the body, stride, and number of the stretch.
    words: Mutex<HashMap<(usize, usize, usize), String>>,
}

impl Trails {
    pub(super) fn new(layout: Layout, style: Style) -> Trails {
        Trails { layout, style, words: Mutex::default() }
    }

    /// Appends the SDL text of the trails up to a frame. `names` are the names of the bodies.
    pub(super) fn write(&self, out: &mut String, plan: &Plan, frame: &Frame, names: &[Arc<str>]) {
        for trail in self.written(plan, frame) {
            self.trail(out, &trail, &names[trail.body]);
        }
    }

    /// Returns the trail files that the script of a frame includes, except those whose names `has` accepts.
    pub(super) fn files(&self, plan: &Plan, frame: &Frame, has: &dyn Fn(&str) -> bool) -> Vec<TrailFile> {
        let mut files = Vec::new();
        if self.layout == Layout::Shared {
            for trail in self.written(plan, frame) {
                for stretch in &trail.stretches {
                    let word = self.word(&trail, stretch);
                    let name = file_name(&word);
                    if !has(&name) {
                        files.push(TrailFile { name, text: self.text(&trail, stretch, &word) });
                    }
                }
            }
        }
        files
    }

    /// Yields the trails that POV-Ray can draw: those with at least two neighboring points that differ enough.
    fn written(&self, plan: &Plan, frame: &Frame) -> impl Iterator<Item = Trail> {
        let style = self.style;
        let can_write = move |trail: &Trail| {
            style.can_write(DVec3::splat(trail.reach))
                && trail.points.windows(2).any(|pair| style.can_tell(pair[0], pair[1]))
        };
        plan.trails(frame).into_iter().filter(can_write)
    }

    fn trail(&self, out: &mut String, trail: &Trail, name: &str) {
        let comment = text::comment(name);
        let stretches = match self.layout {
            Layout::SelfContained => &[],
            Layout::Shared => trail.stretches.as_slice(),
        };
        let words: Vec<String> = stretches.iter().map(|stretch| self.word(trail, stretch)).collect();
        for word in &words {
            out.push_str(&format!("#include \"{}\"\n", file_name(word)));
        }
        out.push_str(&format!("union {{ // {comment}, trail\n"));
        let mut at = 0;
        for (stretch, word) in stretches.iter().zip(&words) {
            self.own(out, trail, at, stretch.first);
            self.call(out, trail, [&format!("Trail_{word}"), &format!("Shades_{word}")], stretch.first);
            at = stretch.last;
        }
        self.own(out, trail, at, trail.points.len() - 1);
        out.push_str("  ");
        if trail.map.is_none() {
            let color = color(trail.color, self.style);
            out.push_str(&format!(
                "pigment {{ color srgb {color} }} finish {{ ambient 0 emission 0.75 diffuse 0.25 }} "
            ));
        }
        out.push_str("no_shadow no_reflection\n}\n");
    }

    /// Appends the part of a trail from point `first` to point `last`, as an array in the script itself.
    fn own(&self, out: &mut String, trail: &Trail, first: usize, last: usize) {
        // If a body has hardly moved, the part may consist of two equal points, which POV-Ray cannot draw.
        let text = |number: usize| {
            let mut out = String::new();
            self.point(&mut out, trail, number);
            out
        };
        let is_line = last > first + 1 || text(first) != text(last);
        if last > first && is_line {
            out.push_str(&format!("  #local Points = {}", self.array(trail, first, last)));
            if trail.map.is_some() {
                out.push_str(&format!("  #local Shades = {}", shades(trail, first, last)));
            }
            self.call(out, trail, ["Points", "Shades"], first);
        }
    }

    /// Appends the macro call that draws an array of points. `shades` is the array of their colors, for a trail whose color follows a
    /// value. `first` is the index of the array's first point in the trail.
    fn call(&self, out: &mut String, trail: &Trail, [points, shades]: [&str; 2], first: usize) {
        match trail.map {
            Some(map) => out.push_str(&format!("  Shaded_trail({points}, {shades}, {}, ", colors(map))),
            None => out.push_str(&format!("  Trail({points}, ")),
        }
        self.style.length(out, trail.radius_at(first));
        out.push_str(", ");
        self.style.length(out, trail.radius_at(1) - trail.radius_at(0));
        out.push_str(")\n");
    }

    /// Returns the points of a trail from `first` to `last`, as an SDL array.
    fn array(&self, trail: &Trail, first: usize, last: usize) -> String {
        let mut out = format!("array[{}] {{\n", last + 1 - first);
        for number in first..=last {
            self.point(&mut out, trail, number);
            out.push_str(if number < last { ",\n" } else { "\n}\n" });
        }
        out
    }

    /// Returns the SDL text that declares the arrays of a stretch. `word` is part of their names.
    fn text(&self, trail: &Trail, stretch: &Stretch, word: &str) -> String {
        let Stretch { first, last, .. } = *stretch;
        let mut text = format!("#declare Trail_{word} = {}", self.array(trail, first, last));
        if trail.map.is_some() {
            text.push_str(&format!("#declare Shades_{word} = {}", shades(trail, first, last)));
        }
        text
    }

    /// Appends a point of a trail, rounded to the precision that is visible. More digits would make up most of a script.
    fn point(&self, out: &mut String, trail: &Trail, number: usize) {
        let step = trail.fineness;
        self.style.point(out, (trail.points[number] / step).round() * step);
    }

    /// Returns the digest of a stretch's text, which is part of the name of its file.
    fn word(&self, trail: &Trail, stretch: &Stretch) -> String {
        let key = (trail.body, stretch.stride, stretch.number);
        let mut words = self.words.lock().unwrap_or_else(PoisonError::into_inner);
        let word = || {
            let mut text = self.array(trail, stretch.first, stretch.last);
            if trail.map.is_some() {
                text.push_str(&shades(trail, stretch.first, stretch.last));
            }
            let digest = Sha256::digest(text);
            digest[..8].iter().map(|byte| format!("{byte:02x}")).collect()
        };
        words.entry(key).or_insert_with(word).clone()
    }
}

/// Appends the colors of the color maps that trails have.
pub(super) fn declare(out: &mut String, plan: &Plan, layout: Layout, style: Style) {
    let scope = match layout {
        Layout::Shared => "declare",
        Layout::SelfContained => "local",
    };
    let maps = plan.mapped_colors();
    for map in plan.maps_of_trails() {
        let of_map: Vec<String> = maps[map].iter().map(|it| color(*it, style)).collect();
        let list = of_map.join(",\n");
        out.push_str(&format!("#{scope} {} = array[{}] {{\n{list}\n}}\n", colors(map), of_map.len()));
    }
}

/// Returns the name of the array with the colors of a map.
fn colors(map: usize) -> String {
    format!("Colors_of_map_{map}")
}

/// Returns the numbers of the colors of a trail's points from `first` to `last`, as an SDL array.
fn shades(trail: &Trail, first: usize, last: usize) -> String {
    let shades: Vec<String> = trail.shades[first..=last].iter().map(u16::to_string).collect();
    format!("array[{}] {{ {} }}\n", shades.len(), shades.join(", "))
}

fn file_name(word: &str) -> String {
    format!("trail_{word}.inc")
}

/// Returns true if a file name is that of a trail file.
pub fn is_trail_file(name: &str) -> bool {
    let word = name.strip_prefix("trail_").and_then(|name| name.strip_suffix(".inc"));
    let is_digit = |byte: u8| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte);
    word.is_some_and(|word| word.len() == 16 && word.bytes().all(is_digit))
}
