//! Tests of the pages in `docs/` whose commands need no program but jabuka, and of the links of all pages. This command writes the real
//! outputs into the pages: `JABUKA_UPDATE_DOCS=1 cargo test --test docs pages`.

use std::collections::BTreeSet;
use std::fs;

use crate::page::Page;
use crate::support;

#[test]
fn the_page_of_reports_is_real() {
    Page::check("docs/report.md", &[]).check_pictures();
}

#[test]
fn the_page_of_templates_is_real() {
    Page::check("docs/reuse.md", &[]).check_pictures();
}

#[test]
fn every_folder_says_what_may_be_touched() {
    let text = fs::read_to_string(support::root().join("ARCHITECTURE.md")).unwrap();
    let section = text.split("\n## ").find(|section| section.starts_with("What you may touch")).unwrap();
    let folders = |parent: &str| -> Vec<String> {
        let entries = fs::read_dir(support::root().join(parent)).unwrap().map(|entry| entry.unwrap().path());
        let folders = entries.filter(|path| path.is_dir());
        folders.map(|path| format!("{parent}{}", path.file_name().unwrap().to_string_lossy())).collect()
    };
    let own = |name: &String| !name.starts_with('.') && !["src", "target", "out"].contains(&name.as_str());
    let all: Vec<String> = folders("src/").into_iter().chain(folders("").into_iter().filter(own)).collect();
    let missing: Vec<_> = all.iter().filter(|name| !section.contains(&format!("| `{name}/` |"))).collect();
    assert!(missing.is_empty(), "no row for {missing:?}");
    let rows = section.lines().filter(|line| line.starts_with("| `")).count();
    assert_eq!(rows, all.len(), "a row for a folder that is not there");
}

#[test]
fn the_workflow_tests_the_oldest_rust_that_the_manifest_allows() {
    let read = |name: &str| fs::read_to_string(support::root().join(name)).unwrap();
    let manifest = read("Cargo.toml");
    let line = manifest.lines().find_map(|line| line.strip_prefix("rust-version = ")).unwrap();
    assert!(read(".github/workflows/ci.yml").contains(&format!("rust: {line}\n")), "not tested: {line}");
}

/// Returns the anchors that GitHub derives from the headings of a page, as links use them.
fn headings(page: &str) -> BTreeSet<String> {
    let is_kept = |c: &char| c.is_alphanumeric() || [' ', '-', '_'].contains(c);
    let name =
        |heading: &str| heading.to_lowercase().chars().filter(is_kept).collect::<String>().replace(' ', "-");
    let headings = page.lines().filter(|line| line.starts_with('#'));
    headings.map(|line| name(line.trim_start_matches('#').trim())).collect()
}

#[test]
fn every_link_leads_to_a_file_and_a_heading_that_are_there() {
    let docs = fs::read_dir(support::root().join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let mut pages: Vec<_> = docs.filter(|path| path.extension().is_some_and(|end| end == "md")).collect();
    pages.extend(
        ["README.md", "CONTRIBUTING.md", "ARCHITECTURE.md", "CHANGELOG.md"]
            .map(|name| support::root().join(name)),
    );
    let mut broken = Vec::new();
    for path in &pages {
        let text = fs::read_to_string(path).unwrap();
        let links = text.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(link, _)| link);
        for link in links.filter(|link| !link.starts_with("http")) {
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { path.clone() } else { path.with_file_name(file) };
            let is_there = match heading {
                "" => target.exists(),
                _ => headings(&fs::read_to_string(&target).unwrap_or_default()).contains(heading),
            };
            if !is_there {
                broken.push(format!("{}: {link}", path.display()));
            }
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
}
