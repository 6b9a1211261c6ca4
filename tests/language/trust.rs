//! What SDL may do without `--trust`, held against POV-Ray and its own files.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::support::{jabuka, stderr};
use jabuka::scene::sdl::{Token, Tokens, WRITING_MACROS, Where, refusals};

/// Where Debian installs POV-Ray's include files and the examples.
const INCLUDES: &str = "/usr/share/povray-3.7/include";
const EXAMPLES: &str = "/usr/share/doc/povray/examples";

/// A scene: what the error names, the table with the SDL, and files beside the scene.
type Hostile = (&'static str, &'static str, &'static [(&'static str, &'static str)]);

/// Scenes whose SDL would overwrite, include or read files of their user.
const HOSTILE: [Hostile; 13] = [
    ("`include`", "[povray]\nsdl = '''\n  include \"VICTIM\"\n'''", &[]),
    ("`#`", "[povray]\nsdl = '#macro A() # #end A() include \"VICTIM\"'", &[]),
    ("`save_file`", "[povray]\nsdl = 'global_settings { photons { count 9 save_file \"VICTIM\" } }'", &[]),
    ("`load_file`", "[povray]\nsdl = 'global_settings { photons { count 9 load_file \"VICTIM\" } }'", &[]),
    ("`VICTIM`", "[material.red]\nsdl = 'pigment { image_map { png \"VICTIM\" } }'", &[]),
    ("`png`", "[povray]\nsdl = '#declare F = \"VICTIM\"; #declare P = pigment { image_map { png F } }'", &[]),
    ("`concat`", "[povray]\nsdl = 'height_field { concat(\"VICT\", \"IM\") }'", &[]),
    ("`fopen`", "[body.box]\nshape.box.size = [1, 1, 1]\nlook.sdl_after = '#fopen F \"VICTIM\" write'", &[]),
    ("`Parse_String`", "[povray]\nsdl = 'Parse_String(\"#fopen F \\\"VICTIM\\\" write\")'", &[]),
    ("`fopen`", "[povray]\nassets = [\"a.inc\"]", &[("a.inc", "#fopen F \"VICTIM\" write")]),
    (
        "`write`",
        "[povray]\nassets = [\"a.txt\"]\nsdl = '#include \"a.txt\"'",
        &[("a.txt", "\n\n  #write(F, 1)")],
    ),
    (
        "`VICTIM`",
        "[povray]\nassets = [\"a.txt\", \"b\"]\nsdl = '#include \"a.txt\"'",
        &[("a.txt", "#include \"b\""), ("b", "#include \"VICTIM\"")],
    ),
    ("`fopen`", "[povray]\ninclude = [\"a.inc\"]", &[("a.inc", "/* /* */ */ #fopen F \"VICTIM\" write")]),
];

#[test]
fn hostile_sdl_is_refused_at_its_place_and_its_victim_stays_as_it_was() {
    for (named, scene, files) in HOSTILE {
        let folder = tempfile::tempdir().unwrap();
        let victim = folder.path().join("victim.txt");
        fs::write(&victim, "precious").unwrap();
        let beside = folder.path().join("scene");
        fs::create_dir(&beside).unwrap();
        let name = victim.display().to_string();
        let with_victim = |text: &str| text.replace("VICTIM", &name);
        for (file, text) in files {
            fs::write(beside.join(file), with_victim(text)).unwrap();
        }
        let body = "\n[body.ball]\nshape.sphere.radius = 1\n";
        fs::write(beside.join("scene.toml"), with_victim(scene) + body).unwrap();
        let output = compile(&beside);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(1), "{scene}\n{said}");
        let named = if named == "`concat`" { "`height_field`".to_owned() } else { with_victim(named) };
        assert!(said.contains(&named) || named == "`#`" && said.contains("this `#`"), "{scene}\n{said}");
        assert!(said.contains("error[untrusted-sdl]"), "{scene}\n{said}");
        let place = said.lines().find(|line| line.trim_start().starts_with("--> ")).unwrap_or_default();
        assert!(place.split(':').count() >= 3, "a line and a column: {scene}\n{said}");
        assert_eq!(fs::read_to_string(&victim).unwrap(), "precious");
        assert!(!beside.join("out").exists(), "{scene}");
    }
}

#[test]
fn an_asset_that_is_sdl_may_name_other_assets_and_what_comes_with_povray() {
    let folder = tempfile::tempdir().unwrap();
    let parts = "#include \"colors.inc\"\n#include \"maps/wood\"\n#declare Font = 1; // Latin-1: \u{e9}\n";
    fs::create_dir(folder.path().join("maps")).unwrap();
    fs::write(folder.path().join("parts.inc"), parts.chars().map(|c| c as u8).collect::<Vec<u8>>()).unwrap();
    fs::write(folder.path().join("maps/wood"), "#declare Wood = pigment { image_map { png \"x.png\" } }\n")
        .unwrap();
    fs::write(folder.path().join("x.png"), "").unwrap();
    let scene = "[povray]\nassets = [\"parts.inc\", \"./maps/wood\", \"x.png\"]\n\
                 sdl = '#include \"parts.inc\" #declare T = text { ttf \"timrom.ttf\" \"/etc/passwd\" 1, 0 }'\n\
                 [body.ball]\nshape.sphere.radius = 1\nmaterial = \"wood\"\n\
                 [material.wood]\nsdl = 'pigment { Wood }'\n";
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    let output = compile(folder.path());
    assert!(output.status.success(), "{}", stderr(&output));
}

fn compile(folder: &Path) -> Output {
    jabuka().current_dir(folder).args(["compile", "scene.toml", "-o", "out"]).output().unwrap()
}

/// Pieces of SDL that artists keep and share: what a `#declare` or a top-level object spans, and macros.
fn pieces(text: &str) -> Vec<&str> {
    let mut pieces = Vec::new();
    let mut tokens = Tokens::of(text).peekable();
    while let Some((token, Range { start, .. })) = tokens.next() {
        let Some((Token::Word(next), _)) = tokens.peek().cloned() else { continue };
        let (mut braces, mut directives, mut hash) = (0, 0, token == Token::Symbol('#'));
        if hash && !["declare", "local", "macro"].contains(&next) {
            continue;
        }
        let is_macro = next == "macro";
        // Up to the `#end` of a macro, or to the brace that closes the first one.
        for (token, range) in tokens.by_ref() {
            match token {
                Token::Word("if" | "ifdef" | "ifndef" | "while" | "for" | "switch" | "macro") if hash => {
                    directives += 1;
                }
                Token::Word("end") if hash => directives -= 1,
                Token::Symbol('{') => braces += 1,
                Token::Symbol('}') => braces -= 1,
                Token::Symbol(';') if braces == 0 && directives == 0 => break,
                _ => {}
            }
            hash = token == Token::Symbol('#');
            let closes = if is_macro { Token::Word("end") } else { Token::Symbol('}') };
            if token == closes && braces <= 0 && directives <= 0 {
                pieces.push(&text[start..range.end]);
                break;
            }
        }
    }
    pieces
}

/// Whether a piece reads or writes files as data, which no scene may do without `--trust`.
fn does_io(piece: &str) -> bool {
    let words = ["fopen", "fclose", "read", "write", "save_file", "load_file"];
    Tokens::of(piece).any(|(token, _)| {
        matches!(token, Token::Word(word) if words.contains(&word) || WRITING_MACROS.contains(&word))
    })
}

#[test]
fn what_artists_use_passes() {
    let mut files = Vec::new();
    below(Path::new(EXAMPLES), &mut files);
    assert!(files.len() > 400, "{} examples: is povray-examples installed?", files.len());
    let [mut passed, mut all, mut whole_passed, mut whole] = [0usize; 4];
    let mut refused = BTreeMap::<String, usize>::new();
    for path in files {
        let text = String::from_utf8_lossy(&fs::read(&path).unwrap()).into_owned();
        // An artist lists the files beside an example as assets.
        let folder = path.parent().unwrap();
        let is_asset = |name: &str| !name.contains("..") && folder.join(name).is_file();
        let mut passes = |text: &str| {
            let refused_here = refusals(text, Where::Top, is_asset).0;
            refused_here
                .first()
                .inspect(|first| *refused.entry(format!("{:?}", first.why)).or_default() += 1)
                .is_none()
        };
        if !does_io(&text) {
            whole += 1;
            whole_passed += usize::from(passes(&text));
        }
        for piece in pieces(&text).into_iter().filter(|piece| !does_io(piece)) {
            all += 1;
            passed += usize::from(passes(piece));
        }
    }
    println!(
        "{passed} of {all} objects, textures and macros pass, {whole_passed} of {whole} whole files: {refused:#?}"
    );
    assert!(all > 3000 && passed * 100 >= all * 98, "{passed} of {all}: {refused:#?}");
    assert!(whole > 400 && whole_passed * 100 >= whole * 90, "{whole_passed} of {whole}: {refused:#?}");
}

/// SDL files below a folder.
fn below(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.is_symlink() {
            below(&path, files);
        } else if path.extension().is_some_and(|end| end == "pov" || end == "inc") {
            files.push(path);
        }
    }
}

#[test]
fn the_macros_of_povray_that_write_files_are_known() {
    let mut bodies: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let mut files = Vec::new();
    below(Path::new(INCLUDES), &mut files);
    assert!(files.len() > 35, "{files:?}");
    for path in files {
        if ["makegrass.inc", "meshmaker.inc"].iter().any(|name| path.ends_with(name)) {
            continue;
        }
        let text = String::from_utf8_lossy(&fs::read(&path).unwrap()).into_owned();
        // Which `#end` closes a macro, and which something in it.
        let mut open: Vec<Option<String>> = Vec::new();
        let (mut hash, mut opens_macro) = (false, false);
        for (token, _) in Tokens::of(&text) {
            if let Token::Word(word) = token {
                match word {
                    _ if opens_macro => open.push(Some(word.to_owned())),
                    "if" | "ifdef" | "ifndef" | "while" | "for" | "switch" if hash => open.push(None),
                    "end" if hash => drop(open.pop()),
                    _ => {}
                }
                for name in open.iter().flatten() {
                    bodies.entry(name.clone()).or_default().insert(word.to_owned());
                }
                opens_macro = hash && word == "macro";
                let is_file = ["fopen", "write", "save_file", "load_file"].contains(&word);
                assert!(
                    !is_file || open.iter().any(Option::is_some),
                    "{} outside of a macro",
                    path.display()
                );
            }
            hash = token == Token::Symbol('#');
        }
        assert_eq!(open, [], "{}", path.display());
    }
    let mut writing: BTreeSet<String> = ["fopen", "write"].map(str::to_owned).into();
    loop {
        let more: BTreeSet<String> = bodies
            .iter()
            .filter(|(name, body)| !writing.contains(*name) && body.iter().any(|word| writing.contains(word)))
            .map(|(name, _)| name.clone())
            .collect();
        if more.is_empty() {
            break;
        }
        writing.extend(more);
    }
    writing.retain(|name| bodies.contains_key(name));
    assert_eq!(writing, WRITING_MACROS.map(str::to_owned).into());
}

/// POV-Ray has no reserved word that the lists lack: it declares every other word that its program holds.
#[test]
fn all_reserved_words_of_povray_are_known() {
    let program = ["/usr/bin/povray", "/usr/local/bin/povray"]
        .into_iter()
        .find_map(|path| fs::read(path).ok())
        .unwrap();
    let is_of_a_word = |byte: &u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || *byte == b'_';
    let mut words = BTreeSet::new();
    // A linker may store a word as the end of a longer one.
    for run in program.split(|byte| !is_of_a_word(byte)).filter(|run| (2..=40).contains(&run.len())) {
        let run = std::str::from_utf8(run).unwrap();
        words.extend(
            (0..run.len() - 1)
                .map(|at| &run[at..])
                .filter(|word| word.starts_with(|c: char| c.is_ascii_lowercase())),
        );
    }
    let known = jabuka::scene::sdl::reserved_words();
    assert!(known.iter().all(|word| word.len() < 2 || words.contains(word)), "POV-Ray has fewer words");
    let others: Vec<&&str> = words.iter().filter(|word| known.binary_search(word).is_err()).collect();
    assert!(others.len() > 1000);
    let folder = tempfile::tempdir().unwrap();
    let declare = |word: &&&str| format!("#declare {word} = 1;\n");
    let script: String = others.iter().map(declare).collect();
    fs::write(folder.path().join("x.pov"), format!("#version 3.7;\n{script}#error \"all declared\"\n"))
        .unwrap();
    let arguments = ["-D", "-V", "-GA", "+GFerrors.txt", "+W1", "+H1", "-F", "+Ix.pov"];
    Command::new("povray").current_dir(folder.path()).args(arguments).output().unwrap();
    let said = fs::read_to_string(folder.path().join("errors.txt")).unwrap();
    assert!(said.contains("all declared"), "{said}");
}
