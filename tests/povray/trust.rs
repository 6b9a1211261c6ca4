//! Tests of the SDL that is allowed without `--trust`, compared with POV-Ray's reserved words, include files and examples.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::Command;

use jabuka::scene::sdl::{Token, Tokens, WRITING_MACROS, Where, refusals};

/// The folders in which Debian installs POV-Ray's include files and its examples.
const INCLUDES: &str = "/usr/share/povray-3.7/include";
const EXAMPLES: &str = "/usr/share/doc/povray/examples";

/// Returns the parts of an SDL text that artists keep and share: `#declare` statements, top-level objects and macros.
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
        // A part ends at the `#end` of a macro, or at the brace that closes its first brace.
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

/// Returns true if a part reads or writes data files, which is not allowed without `--trust`.
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
        // The files next to an example count as assets, as an artist would list them.
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

/// Adds all SDL files below a folder to `files`.
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
        // One entry for each open directive: `Some` with the name of a macro, `None` for others. It shows whether an `#end` closes a
        // macro.
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

/// Checks that the lists contain all reserved words of POV-Ray: every other word in its program file can be declared by a script.
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
