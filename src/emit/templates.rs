//! Renders scripts from templates, and formats the values that templates insert.

use std::io;
use std::path::Path;

use minijinja::syntax::SyntaxConfig;
use minijinja::value::{Value, ValueKind};
use minijinja::{Environment, Error, ErrorKind, Output, UndefinedBehavior};

use super::{EmitError, number, text};
use crate::scene::OwnTemplate;
use crate::system::Dir;

/// The built-in templates: file name and text.
pub const TEMPLATES: &[(&str, &str)] = &[
    ("frame.pov", include_str!("../../templates/frame.pov")),
    ("common.inc", include_str!("../../templates/common.inc")),
    ("camera.inc", include_str!("../../templates/camera.inc")),
    ("lights.inc", include_str!("../../templates/lights.inc")),
    ("environment.inc", include_str!("../../templates/environment.inc")),
    ("materials.inc", include_str!("../../templates/materials.inc")),
    ("rounded_box.inc", include_str!("../../templates/rounded_box.inc")),
    ("library/metals.inc", include_str!("../../templates/library/metals.inc")),
    ("library/clear.inc", include_str!("../../templates/library/clear.inc")),
    ("library/smooth.inc", include_str!("../../templates/library/smooth.inc")),
    ("library/soft.inc", include_str!("../../templates/library/soft.inc")),
    ("library/earths.inc", include_str!("../../templates/library/earths.inc")),
    ("library/stones.inc", include_str!("../../templates/library/stones.inc")),
    ("library/woods.inc", include_str!("../../templates/library/woods.inc")),
    ("library/toys.inc", include_str!("../../templates/library/toys.inc")),
    ("library/planets.inc", include_str!("../../templates/library/planets.inc")),
    ("axes.inc", include_str!("../../templates/axes.inc")),
    ("showing.inc", include_str!("../../templates/showing.inc")),
    ("animation.pov", include_str!("../../templates/animation.pov")),
    ("animation.ini", include_str!("../../templates/animation.ini")),
];

/// The documentation of the templates: the names of the files, and the values that they can use.
const README: &str = include_str!("../../templates/README.md");

/// Writes the built-in templates into a folder, and returns their number. Creates the folder if it does not exist.
///
/// # Errors
/// If a file cannot be written, or a file of the same name exists. In the latter case, nothing is written.
pub fn write_templates(folder: &Path) -> io::Result<usize> {
    let files = || TEMPLATES.iter().copied().chain([("README.md", README)]);
    let folder = Dir::make(folder)?;
    for (name, _) in files() {
        if folder.about(name)?.is_some() {
            return Err(io::Error::new(io::ErrorKind::AlreadyExists, format!("`{name}` is there already")));
        }
    }
    for (name, text) in files() {
        if let Some((subfolder, _)) = name.rsplit_once('/') {
            folder.make_folder(subfolder)?;
        }
        io::Write::write_all(&mut folder.create_new(name)?, text.as_bytes()).inspect_err(|_| {
            // The file is removed, since a partly written template is useless.
            let _ = folder.remove_file(name);
        })?;
    }
    Ok(TEMPLATES.len())
}

/// The parsed templates, built-in and the user's own.
pub(super) struct Templates {
    environment: Environment<'static>,
    own: Vec<OwnTemplate>,
}

impl Templates {
    /// Loads the built-in templates. The user's own templates (`own`) replace those of the same name. `digits` is the number of
    /// significant digits of numbers in scripts.
    pub(super) fn new(own: &[OwnTemplate], digits: usize) -> Result<Templates, EmitError> {
        let templates = |environment| Templates { environment, own: own.to_vec() };
        let mut environment =
            environment(digits).map_err(|error| templates(Environment::new()).error(&error))?;
        for OwnTemplate { name, text, .. } in own {
            if let Err(error) = environment.add_template_owned(name.clone(), text.clone()) {
                return Err(templates(environment).error(&error));
            }
        }
        Ok(templates(environment))
    }

    /// Renders the template with this name.
    pub(super) fn render(&self, name: &str, values: &Value) -> Result<String, EmitError> {
        let render = || self.environment.get_template(name)?.render(values.clone());
        render().map_err(|error| self.error(&error))
    }

    /// Returns true if any template uses the value with this name.
    pub(super) fn mention(&self, name: &str) -> bool {
        self.environment.templates().any(|(_, template)| template.undeclared_variables(false).contains(name))
    }

    fn error(&self, error: &Error) -> EmitError {
        EmitError::of_template(error, |name| {
            let own =
                self.own.iter().find(|own| own.name == name).map(|own| (own.path.clone(), own.text.clone()));
            let built_in = TEMPLATES.iter().find(|(built_in, _)| *built_in == name);
            own.or_else(|| built_in.map(|(name, text)| (format!("<{name}>"), (*text).to_owned())))
        })
    }
}

/// Makes the template engine with the built-in templates.
///
/// POV-Ray itself uses `{`, `{#` and `#`, so templates use `<% %>`, `${ }` and `<%# %>`.
fn environment(digits: usize) -> Result<Environment<'static>, Error> {
    let mut environment = Environment::new();
    // In debug mode, errors contain their positions in the template.
    environment.set_debug(true);
    let syntax = SyntaxConfig::builder()
        .block_delimiters("<%", "%>")
        .variable_delimiters("${", "}")
        .comment_delimiters("<%#", "%>")
        .trim_blocks(true)
        .lstrip_blocks(true)
        .keep_trailing_newline(true)
        .build()?;
    environment.set_syntax(syntax);
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    environment.set_formatter(move |out, _, value| format(out, value, digits));
    environment.add_filter("comment", |value: &str| text::comment(value));
    environment.add_filter("string", |value: &str| text::string(value));
    for (name, source) in TEMPLATES {
        environment.add_template(name, source)?;
    }
    Ok(environment)
}

/// Writes a value in SDL. Numbers have `digits` significant digits, and lists of numbers become vectors.
fn format(out: &mut Output<'_>, value: &Value, digits: usize) -> Result<(), Error> {
    match value.kind() {
        ValueKind::String => write_str(out, value.as_str().unwrap_or_default()),
        ValueKind::Number => write_str(out, &number(value, digits)?),
        ValueKind::Seq => {
            let numbers =
                value.try_iter()?.map(|item| number(&item, digits)).collect::<Result<Vec<_>, _>>()?;
            write_str(out, &format!("<{}>", numbers.join(", ")))
        }
        kind => Err(Error::new(ErrorKind::BadSerialization, format!("a script has no way to write {kind}"))),
    }
}

fn number(value: &Value, digits: usize) -> Result<String, Error> {
    if value.is_integer() {
        return Ok(value.to_string());
    }
    let number = f64::try_from(value.clone())?;
    if !number.is_finite() {
        return Err(Error::new(
            ErrorKind::BadSerialization,
            format!("a script has no way to write {number}"),
        ));
    }
    let mut out = String::new();
    number::write(&mut out, number, digits);
    Ok(out)
}

fn write_str(out: &mut Output<'_>, text: &str) -> Result<(), Error> {
    out.write_str(text).map_err(|_| Error::new(ErrorKind::WriteFailure, "cannot write"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn render(source: &str, value: Value) -> Result<String, Error> {
        environment(9)?.render_str(source, minijinja::context! { value })
    }

    #[test]
    fn values_are_written_as_povray_reads_them() {
        assert_eq!(render("${value}", Value::from(1.0 / 3.0)).unwrap(), "0.333333333");
        assert_eq!(render("${value}", Value::from(-0.0)).unwrap(), "0");
        assert_eq!(render("${value}", Value::from(12)).unwrap(), "12");
        assert_eq!(render("${value}", Value::from(vec![1.0, 2.5, 0.0])).unwrap(), "<1, 2.5, 0>");
        assert_eq!(render("// ${value | comment}", Value::from("a\nb")).unwrap(), "// a\\nb");
        assert_eq!(render("\"${value | string}\"", Value::from("a\"b")).unwrap(), "\"a\\\"b\"");
    }

    #[test]
    fn what_povray_cannot_read_is_refused() {
        for value in [Value::from(f64::NAN), Value::from(f64::INFINITY), Value::from(()), Value::from(true)] {
            assert!(render("${value}", value).is_err());
        }
        assert!(render("${no_such_value}", Value::from(1)).is_err());
    }

    #[test]
    fn povrays_own_braces_and_directives_pass() {
        let sdl = "#local A = {# 1 }; { % } # x {{ }}\n";
        assert_eq!(render(sdl, Value::from(1)).unwrap(), sdl);
    }
}
