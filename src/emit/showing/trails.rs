//! Lines along the ways of bodies.
//!
//! The points of a line stand in an array, and the macro `Trail` draws it. In the layout `shared`, each stretch that a
//! body has left behind stands in a file of its own, and a script has the rest of the line alone: else the scripts
//! would repeat the whole way of a body for every frame. A file is named by the digest of its text, so a script that
//! includes it says what is in it, and no file ever changes.

use std::collections::HashMap;
use std::sync::Arc;
use std::sync::{Mutex, PoisonError};

use glam::DVec3;

use super::super::{sdl::Style, text};
use super::color;
use crate::digest::Sha256;
use crate::picture::{Plan, Stretch, Trail};
use crate::scene::Layout;
use crate::simulate::Frame;

/// A file that scripts share: its name and its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrailFile {
    /// Its name: `trail_5f0c1a2b3c4d5e6f.inc`.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// How the trails of a scene are written.
pub(super) struct Trails {
    layout: Layout,
    style: Style,
    /// The words in the names of stretches that have been written, by body, stride and number.
    words: Mutex<HashMap<(usize, usize, usize), String>>,
}

impl Trails {
    pub(super) fn new(layout: Layout, style: Style) -> Trails {
        Trails { layout, style, words: Mutex::default() }
    }

    /// Appends the trails up to a frame of bodies whose names are given.
    pub(super) fn write(&self, out: &mut String, plan: &Plan, frame: &Frame, names: &[Arc<str>]) {
        for trail in self.written(plan, frame) {
            self.trail(out, &trail, &names[trail.body]);
        }
    }

    /// The files that the script of a frame includes, but for those of which `has` says that they are known. It is asked
    /// for the name of each.
    pub(super) fn files(&self, plan: &Plan, frame: &Frame, has: &dyn Fn(&str) -> bool) -> Vec<TrailFile> {
        let mut files = Vec::new();
        if self.layout == Layout::Shared {
            for trail in self.written(plan, frame) {
                for stretch in &trail.stretches {
                    let word = self.word(&trail, stretch);
                    let name = file_name(&word);
                    if !has(&name) {
                        let array = self.array(&trail, stretch.first, stretch.last);
                        files.push(TrailFile { name, text: format!("#declare Trail_{word} = {array}") });
                    }
                }
            }
        }
        files
    }

    /// The trails that can be written.
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
            self.call(out, trail, &format!("Trail_{word}"), stretch.first);
            at = stretch.last;
        }
        self.own(out, trail, at, trail.points.len() - 1);
        let color = color(trail.color, self.style);
        out.push_str(&format!(
            "  pigment {{ color srgb {color} }} finish {{ ambient 0 emission 0.75 diffuse 0.25 }} no_shadow no_reflection\n}}\n"
        ));
    }

    /// Appends a part of a trail that stands in the script itself, from one point to another.
    fn own(&self, out: &mut String, trail: &Trail, first: usize, last: usize) {
        // If a body has hardly moved, two stretches meet in nearly equal points.
        let text = |number: usize| {
            let mut out = String::new();
            self.point(&mut out, trail, number);
            out
        };
        let is_line = last > first + 1 || text(first) != text(last);
        if last > first && is_line {
            out.push_str(&format!("  #local Points = {}", self.array(trail, first, last)));
            self.call(out, trail, "Points", first);
        }
    }

    /// Appends the call that draws an array of points, of which the first has a number in the trail.
    fn call(&self, out: &mut String, trail: &Trail, points: &str, first: usize) {
        out.push_str(&format!("  Trail({points}, "));
        self.style.length(out, trail.radius_at(first));
        out.push_str(", ");
        self.style.length(out, trail.radius_at(1) - trail.radius_at(0));
        out.push_str(")\n");
    }

    /// The points of a trail from one to another.
    fn array(&self, trail: &Trail, first: usize, last: usize) -> String {
        let mut out = format!("array[{}] {{\n", last + 1 - first);
        for number in first..=last {
            self.point(&mut out, trail, number);
            out.push_str(if number < last { ",\n" } else { "\n}\n" });
        }
        out
    }

    /// Appends a point of a trail, as finely as can be seen: more digits would make most of a script.
    fn point(&self, out: &mut String, trail: &Trail, number: usize) {
        let step = trail.fineness;
        self.style.point(out, (trail.points[number] / step).round() * step);
    }

    /// The digest in the name of a stretch.
    fn word(&self, trail: &Trail, stretch: &Stretch) -> String {
        let key = (trail.body, stretch.stride, stretch.number);
        let mut words = self.words.lock().unwrap_or_else(PoisonError::into_inner);
        let word = || {
            let digest = Sha256::digest(self.array(trail, stretch.first, stretch.last));
            digest[..8].iter().map(|byte| format!("{byte:02x}")).collect()
        };
        words.entry(key).or_insert_with(word).clone()
    }
}

fn file_name(word: &str) -> String {
    format!("trail_{word}.inc")
}

/// Whether this is the name of a file with a part of a trail.
pub fn is_trail_file(name: &str) -> bool {
    let word = name.strip_prefix("trail_").and_then(|name| name.strip_suffix(".inc"));
    let is_digit = |byte: u8| byte.is_ascii_digit() || (b'a'..=b'f').contains(&byte);
    word.is_some_and(|word| word.len() == 16 && word.bytes().all(is_digit))
}
