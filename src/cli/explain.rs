//! The command `jabuka explain`: explains the code of an error or a warning, a key of the scene language, or a name that scenes can use.

use crate::catalog::CATEGORIES;
use crate::explain::{Explanation, explanations};
use crate::scene::grammar::{SCENE, find_keys};

use super::{Failure, terminal};

/// Explain the code of an error or a warning, with examples; or a key of a scene
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The code to explain, such as `unknown-key` in `error[unknown-key]`; or a key, such as `body.restitution`. Without it, all codes are
    /// listed
    #[arg(value_name = "CODE or KEY")]
    code: Option<String>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Some(word) = &arguments.code else {
        let rows: Vec<_> = explanations().map(|entry| (entry.code.name(), entry.title())).collect();
        terminal::rows(&rows);
        return Ok(());
    };
    let near_code = match Explanation::of(word) {
        Ok(explanation) => {
            terminal::result(&explanation.to_string());
            return Ok(());
        }
        Err(near) => near,
    };
    let near_key = match find_keys(word) {
        Ok(keys) => {
            match keys.as_slice() {
                [key] => terminal::result(&key.to_string()),
                keys => terminal::rows(
                    &keys.iter().map(|key| (key.path.as_str(), key.spec.meaning)).collect::<Vec<_>>(),
                ),
            }
            return Ok(());
        }
        Err(near) => near,
    };
    // The value of a label, such as `ball.speed`, has the name of a body first.
    let measure = word.split_once('.').filter(|(first, _)| SCENE.key(first).is_none()).map(|(_, last)| last);
    if let Some(text) = name(word).or_else(|| name(measure?)) {
        terminal::result(&text);
        return Ok(());
    }
    let failure = terminal::unknown("code or key", word, near_code.or(near_key.as_deref()));
    let tables: Vec<&str> = SCENE.keys().map(|key| key.name).collect();
    terminal::error(&format!(
        "`jabuka explain` lists the codes; the keys of a scene: {}\n",
        tables.join(", ")
    ));
    Err(failure)
}

/// Explains a name that scenes can use, such as `rk4`, by its entries in the lists of `jabuka list`.
fn name(word: &str) -> Option<String> {
    let lines = CATEGORIES.iter().flat_map(|category| {
        let is_it = |name: &str| name.strip_prefix("BODY.").unwrap_or(name) == word || name == word;
        let entries = (category.entries)().into_iter().filter(move |(name, _)| is_it(name));
        entries.map(|(name, what)| {
            // The columns of a list have no meaning in a sentence.
            let what = what.split_whitespace().collect::<Vec<_>>().join(" ");
            format!("{name}: {what}\nin `jabuka list {}`: {}\n", category.name, category.place)
        })
    });
    let text: Vec<String> = lines.collect();
    (!text.is_empty()).then(|| text.join("\n"))
}
