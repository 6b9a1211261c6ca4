//! Each stage of the program imports only earlier ones.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use crate::support::root;

/// The modules of the library, in an order in which each imports only those before it. A new module gets a line here.
const STAGES: [&str; 32] = [
    "physics",
    "threads",
    "system",
    "diagnostic",
    "explain",
    "font",
    "decimal",
    "lettering",
    "svg",
    "drawing",
    "scene",
    "surface",
    "starter",
    "language_server",
    "catalog",
    "simulate",
    "report",
    "picture",
    "motion_warnings",
    "not_drawn",
    "emit",
    "cache",
    "run",
    "sandbox",
    "output",
    "render",
    "doctor",
    "overwrite",
    "export",
    "page",
    "preview",
    "cli",
];

/// Returns the stage of a name in the root of the library.
fn stage(name: &str) -> Option<usize> {
    let module = match name {
        "Run" | "RunError" => "run",
        "Scene" => "scene",
        module => module,
    };
    STAGES.iter().position(|stage| *stage == module)
}

/// Returns the first part of each path in a text that begins with `crate::`, also of paths in braces.
fn imports(text: &str) -> BTreeSet<&str> {
    fn first(path: &str) -> &str {
        path.trim_start().split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or_default()
    }
    let mut names = BTreeSet::new();
    for rest in text.split("crate::").skip(1) {
        let Some(list) = rest.strip_prefix('{') else {
            names.insert(first(rest));
            continue;
        };
        let (mut depth, mut start) = (1, 0);
        for (at, c) in list.char_indices() {
            depth += i32::from(c == '{') - i32::from(c == '}');
            if depth == 0 || depth == 1 && c == ',' {
                names.insert(first(&list[start..at]));
                start = at + 1;
            }
            if depth == 0 {
                break;
            }
        }
    }
    names.remove("");
    names
}

/// Checks the imports of all files below a path. Unit tests may import what they like.
fn check(path: &Path, own: usize, wrong: &mut Vec<String>) {
    if path.is_dir() {
        for entry in fs::read_dir(path).unwrap() {
            check(&entry.unwrap().path(), own, wrong);
        }
        return;
    }
    let file = path.strip_prefix(root()).unwrap();
    if path.extension().is_none_or(|end| end != "rs")
        || file.components().any(|part| ["tests", "tests.rs"].iter().any(|name| part.as_os_str() == *name))
    {
        return;
    }
    let text = fs::read_to_string(path).unwrap();
    let code = text.split("#[cfg(test)]\nmod").next().unwrap();
    for name in imports(code) {
        let file = file.display();
        match stage(name) {
            None => wrong.push(format!("{file}: `{name}` is not in the list of stages")),
            Some(other) if other > own => {
                wrong.push(format!("{file}: `{}` imports `{}`, a later stage", STAGES[own], STAGES[other]));
            }
            Some(_) => {}
        }
    }
}

#[test]
fn imports_of_all_kinds_are_found() {
    let text = "use crate::{Run, a::{self, b}, c};\nlet x: crate::d::E = super::f();";
    assert_eq!(imports(text).into_iter().collect::<Vec<_>>(), ["Run", "a", "c", "d"]);
}

#[test]
fn each_stage_imports_only_earlier_ones() {
    let mut wrong = Vec::new();
    for entry in fs::read_dir(root().join("src")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        // The program itself uses the library by its name.
        if ["lib", "main", "cli"].contains(&&*name)
            || path.is_file() && path.extension().is_none_or(|end| end != "rs")
        {
            continue;
        }
        match stage(&name) {
            Some(own) => check(&path, own, &mut wrong),
            None => wrong.push(format!("src/{name} is not in the list of stages")),
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
