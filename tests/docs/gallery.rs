//! The page `docs/gallery.md` has a card for each scene of the gallery: its picture, title and first comment.
//!
//! After a change of the scenes, this command writes the page again: `JABUKA_UPDATE_DOCS=1 cargo test --test docs gallery`. The pictures are
//! made by `docs/gallery.sh`.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use crate::reference::is_up_to_date;

/// The number of cards in a row.
const CARDS_PER_ROW: usize = 3;

/// The topics of the page, each with a text that only the scenes of this topic contain. A scene belongs to the first topic that fits.
const TOPICS: [(&str, &str); 5] = [
    ("Particles", "\n[emitter."),
    ("Impacts and piles", "\ncontacts = "),
    ("Pendulums and machines", "\n[joint."),
    ("Planets, stars and atoms", "gravitation"),
    ("Motion and forces", ""),
];

#[test]
fn the_gallery_has_a_card_for_each_scene() {
    let mut cards: [Vec<String>; TOPICS.len()] = Default::default();
    let mut names = BTreeSet::new();
    for path in files("scenes", "toml") {
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        let title =
            jabuka::Scene::from_path(&path).unwrap().title.expect("a scene of the gallery has a title");
        let topic = TOPICS.iter().position(|(_, sign)| text.contains(sign)).unwrap();
        let about = first_comment(&text);
        cards[topic].push(format!(
            "[![{title}](gallery/{name}.jpg)](../scenes/{name}.toml)<br>**{title}**<br>{about}"
        ));
        names.insert(name);
    }
    let pictures: BTreeSet<String> = files("docs/gallery", "jpg")
        .iter()
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect();
    assert_eq!(pictures, names, "docs/gallery.sh makes the pictures");
    let mut page = INTRODUCTION.to_owned();
    for ((topic, _), cards) in TOPICS.iter().zip(&cards) {
        write!(
            page,
            "\n## {topic}\n\n|{}\n|{}\n",
            "   |".repeat(CARDS_PER_ROW),
            " --- |".repeat(CARDS_PER_ROW)
        )
        .unwrap();
        for row in cards.chunks(CARDS_PER_ROW) {
            writeln!(page, "| {} |", row.join(" | ")).unwrap();
        }
    }
    is_up_to_date("gallery.md", &page);
}

/// Returns the comment at the head of a scene, up to its first empty line.
fn first_comment(text: &str) -> String {
    let lines = text.lines().map_while(|line| line.strip_prefix("# "));
    lines.collect::<Vec<_>>().join(" ")
}

fn files(folder: &str, ending: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let files = std::fs::read_dir(folder).expect("the folder is there").map(|file| file.unwrap().path());
    let mut files: Vec<PathBuf> =
        files.filter(|path| path.extension().is_some_and(|is| is == ending)).collect();
    files.sort();
    files
}

const INTRODUCTION: &str = "# The gallery

Each picture is one frame of a scene. A click on it opens the scene, whose first comment says more. `jabuka preview scenes/bounce.toml` shows
a scene in motion.
";
