//! Converts units that people write after numbers to the units of the scene language.

/// A unit of measurement: its names, the scene language's unit for the same quantity, and the factor that converts to the latter.
struct Unit {
    names: &'static [&'static str],
    of: &'static str,
    factor: f64,
}

const fn unit(names: &'static [&'static str], of: &'static str, factor: f64) -> Unit {
    Unit { names, of, factor }
}

/// The length of a Julian year, s.
const JULIAN_YEAR: f64 = 365.25 * 86_400.0;
/// The angle of one degree, rad.
const RADIANS_PER_DEGREE: f64 = std::f64::consts::PI / 180.0;

/// The known units, grouped by quantity. The unit of the scene language comes first in each group.
static UNITS: &[Unit] = &[
    unit(&["s", "sec", "second", "seconds"], "s", 1.0),
    unit(&["ns"], "s", 1e-9),
    unit(&["us", "µs", "μs"], "s", 1e-6),
    unit(&["ms"], "s", 1e-3),
    unit(&["min", "minute", "minutes"], "s", 60.0),
    unit(&["h", "hr", "hour", "hours"], "s", 3600.0),
    unit(&["d", "day", "days"], "s", 86_400.0),
    unit(&["yr", "y", "a", "year", "years"], "s", JULIAN_YEAR),
    unit(&["m", "meter", "meters", "metre", "metres"], "m", 1.0),
    unit(&["pm"], "m", 1e-12),
    // Unicode has two characters for the angstrom sign.
    unit(&["Å", "Å", "A", "angstrom", "ångström"], "m", 1e-10),
    unit(&["nm"], "m", 1e-9),
    unit(&["um", "µm", "μm"], "m", 1e-6),
    unit(&["mm"], "m", 1e-3),
    unit(&["cm"], "m", 1e-2),
    unit(&["dm"], "m", 1e-1),
    unit(&["km"], "m", 1e3),
    unit(&["in", "inch"], "m", 0.0254),
    unit(&["ft", "foot", "feet"], "m", 0.3048),
    // The value of the astronomical unit is from resolution B2 of the IAU, 2012.
    unit(&["AU", "au", "ua"], "m", 149_597_870_700.0),
    unit(&["ly"], "m", 299_792_458.0 * JULIAN_YEAR),
    // A parsec is 648000/π astronomical units (resolution B2 of the IAU, 2015).
    unit(&["pc"], "m", 149_597_870_700.0 * 648_000.0 / std::f64::consts::PI),
    unit(&["kg"], "kg", 1.0),
    unit(&["mg"], "kg", 1e-6),
    unit(&["g", "gram", "grams"], "kg", 1e-3),
    unit(&["t", "ton", "tons"], "kg", 1e3),
    // The value of the atomic mass unit is from CODATA 2022.
    unit(&["u", "Da"], "kg", 1.660_539_068_92e-27),
    unit(&["m/s", "m s^-1", "mps"], "m/s", 1.0),
    unit(&["mm/s"], "m/s", 1e-3),
    unit(&["cm/s"], "m/s", 1e-2),
    unit(&["km/s"], "m/s", 1e3),
    unit(&["km/h", "kmh", "kph"], "m/s", 1.0 / 3.6),
    unit(&["mph"], "m/s", 0.447_04),
    unit(&["AU/d", "AU/day", "au/d", "au/day"], "m/s", 149_597_870_700.0 / 86_400.0),
    unit(&["AU/yr", "au/yr"], "m/s", 149_597_870_700.0 / JULIAN_YEAR),
    unit(&["Å/ps", "Å/ps"], "m/s", 100.0),
    unit(&["Å/fs", "Å/fs"], "m/s", 1e5),
    unit(&["nm/ps"], "m/s", 1e3),
    unit(&["m/s²", "m/s^2", "m/s2", "m/s**2", "m s^-2"], "m/s²", 1.0),
    unit(&["mm/s²", "mm/s^2", "mm/s2"], "m/s²", 1e-3),
    unit(&["cm/s²", "cm/s^2", "cm/s2"], "m/s²", 1e-2),
    unit(&["km/s²", "km/s^2", "km/s2"], "m/s²", 1e3),
    unit(&["rad/s", "1/s", "s^-1"], "rad/s", 1.0),
    unit(&["deg/s", "°/s"], "rad/s", RADIANS_PER_DEGREE),
    unit(&["rpm", "rev/min"], "rad/s", std::f64::consts::TAU / 60.0),
    unit(&["°", "deg", "degree", "degrees"], "degrees", 1.0),
    unit(&["rad", "radian", "radians"], "degrees", 1.0 / RADIANS_PER_DEGREE),
    unit(&["rev", "turn", "turns"], "degrees", 360.0),
    unit(&["N"], "N", 1.0),
    unit(&["pN"], "N", 1e-12),
    unit(&["nN"], "N", 1e-9),
    unit(&["uN", "µN", "μN"], "N", 1e-6),
    unit(&["mN"], "N", 1e-3),
    unit(&["kN"], "N", 1e3),
    unit(&["MN"], "N", 1e6),
    unit(&["N·m", "N*m", "Nm", "N m"], "N·m", 1.0),
    unit(&["mN·m", "mN*m", "mNm"], "N·m", 1e-3),
    unit(&["kN·m", "kN*m", "kNm"], "N·m", 1e3),
    unit(&["J"], "J", 1.0),
    unit(&["nJ"], "J", 1e-9),
    unit(&["uJ", "µJ", "μJ"], "J", 1e-6),
    unit(&["mJ"], "J", 1e-3),
    unit(&["kJ"], "J", 1e3),
    unit(&["MJ"], "J", 1e6),
    unit(&["GJ"], "J", 1e9),
    unit(&["kWh"], "J", 3.6e6),
    unit(&["cal"], "J", 4.184),
    unit(&["kcal"], "J", 4184.0),
    // The electronvolt is exact since the SI of 2019.
    unit(&["meV"], "J", 1.602_176_634e-22),
    unit(&["eV"], "J", 1.602_176_634e-19),
    unit(&["keV"], "J", 1.602_176_634e-16),
    unit(&["MeV"], "J", 1.602_176_634e-13),
    unit(&["W"], "W", 1.0),
    unit(&["uW", "µW", "μW"], "W", 1e-6),
    unit(&["mW"], "W", 1e-3),
    unit(&["kW"], "W", 1e3),
    unit(&["MW"], "W", 1e6),
    unit(&["kg·m/s", "kg*m/s", "kg m/s", "N·s", "N*s", "Ns"], "kg·m/s", 1.0),
    unit(&["g·cm/s", "g*cm/s"], "kg·m/s", 1e-5),
    unit(&["kg·m²/s", "kg*m^2/s", "kg*m²/s", "J·s", "J*s"], "kg·m²/s", 1.0),
    unit(&["g·cm²/s", "g*cm^2/s", "g*cm²/s"], "kg·m²/s", 1e-7),
    unit(&["C"], "C", 1.0),
    unit(&["mC"], "C", 1e-3),
    unit(&["uC", "µC", "μC"], "C", 1e-6),
    unit(&["nC"], "C", 1e-9),
    unit(&["pC"], "C", 1e-12),
    // The elementary charge is exact since the SI of 2019.
    unit(&["e"], "C", 1.602_176_634e-19),
    unit(&["T"], "T", 1.0),
    unit(&["mT"], "T", 1e-3),
    unit(&["V/m", "N/C"], "V/m", 1.0),
    unit(&["kV/m"], "V/m", 1e3),
    unit(&["N/m"], "N/m", 1.0),
    unit(&["N/cm"], "N/m", 100.0),
    unit(&["N·s/m", "N*s/m", "Ns/m", "kg/s"], "N·s/m", 1.0),
    unit(&["kg/m³", "kg/m^3", "kg/m3", "kg/m**3"], "kg/m³", 1.0),
    unit(&["g/cm³", "g/cm^3", "g/cm3", "g/cc"], "kg/m³", 1e3),
    unit(&["frames/s", "fps", "Hz"], "frames/s", 1.0),
    unit(&["px", "pixel", "pixels"], "pixels", 1.0),
];

/// Returns the factor that converts `unit` to the unit `of`, which is a unit of the scene language. `None` if the two units measure
/// different quantities.
pub(super) fn factor(unit: &str, of: &str) -> Option<f64> {
    let is_it = |known: &&Unit| known.of == of && known.names.contains(&unit);
    UNITS.iter().find(is_it).map(|known| known.factor)
}

/// Returns the scene language's unit for the quantity that a unit measures, and the factor that converts to it. `None` for unknown units.
pub(super) fn si(unit: &str) -> Option<(&'static str, f64)> {
    let known = UNITS.iter().find(|known| known.names.contains(&unit))?;
    Some((if known.of == "degrees" { "°" } else { known.of }, known.factor))
}

/// Returns whether a word is probably meant as a unit.
pub(super) fn is_unit(word: &str) -> bool {
    UNITS.iter().any(|unit| unit.names.contains(&word)) || matches!(word, "Pa" | "K" | "V" | "A")
}

/// Returns the factor that converts a unit to the scene language's unit. `None` for unknown units, and for names of one letter, which are
/// more likely names of variables.
pub(super) fn of_several_letters(name: &str) -> Option<f64> {
    let is_it = |unit: &&Unit| unit.names.contains(&name);
    if name.len() < 2 { None } else { UNITS.iter().find(is_it).map(|unit| unit.factor) }
}

/// Returns the most common name of each unit that converts to the unit `of`, beginning with `of` itself.
pub(super) fn usual(of: &str) -> Vec<&'static str> {
    UNITS.iter().filter(|unit| unit.of == of).map(|unit| unit.names[0]).collect()
}

/// Splits a text such as `2.5 km` into the number and the unit. `None` for other texts.
pub(super) fn quantity(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let mut bytes = text.bytes().enumerate().peekable();
    let mut end = 0;
    while let Some((at, byte)) = bytes.next() {
        let after = bytes.peek().map(|(_, byte)| *byte);
        let is_part = match byte {
            b'0'..=b'9' | b'.' => true,
            b'+' | b'-' => at == 0 || matches!(text.as_bytes()[at - 1], b'e' | b'E'),
            b'e' | b'E' => after.is_some_and(|byte| byte.is_ascii_digit() || matches!(byte, b'+' | b'-')),
            _ => false,
        };
        if !is_part {
            break;
        }
        end = at + 1;
    }
    let number = text[..end].parse::<f64>().ok()?;
    let unit = text[end..].trim();
    is_unit(unit).then_some((number, unit))
}

/// Converts a number from `unit` to the unit `of` of a key, and returns its TOML text. If `of` is empty, converts to the scene language's
/// unit for the same quantity. `None` if the units measure different quantities.
pub(super) fn converted(number: f64, unit: &str, of: &str) -> Option<String> {
    let factor = match (factor(unit, of), of) {
        (None, "") => UNITS.iter().find(|known| known.names.contains(&unit)).map(|known| known.factor),
        // For an angular velocity, read degrees as degrees per second.
        (None, "rad/s") => factor(unit, "degrees").map(|degrees| degrees * RADIANS_PER_DEGREE),
        (factor, _) => factor,
    };
    factor.map(|factor| written(number * factor))
}

/// Returns the number for a percentage such as `80%`, as TOML text. `None` for other texts.
pub(super) fn percentage(text: &str) -> Option<String> {
    let number = text.trim().strip_suffix('%')?.trim_end().parse::<f64>().ok()?;
    number.is_finite().then(|| written(number / 100.0))
}

/// Formats a number as TOML, rounded to 13 significant digits, which removes the rounding error of a conversion.
pub(super) fn written(number: f64) -> String {
    let rounded = format!("{number:.12e}").parse::<f64>().unwrap_or(number);
    if rounded == 0.0 || (1e-4..1e7).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::font::{Typeface, Weight};

    #[test]
    fn numbers_with_units_are_read_and_others_are_not() {
        for (text, expected) in [
            ("2 m", Some((2.0, "m"))),
            ("5kg", Some((5.0, "kg"))),
            ("-1.5e-3 km/h", Some((-1.5e-3, "km/h"))),
            ("90°", Some((90.0, "°"))),
            ("1.6e", Some((1.6, "e"))),
            ("2", None),
            ("m", None),
            ("2 x", None),
            ("2*m", None),
        ] {
            assert_eq!(quantity(text), expected, "{text}");
        }
    }

    #[test]
    fn quantities_are_converted_to_the_unit_of_the_key() {
        for (number, unit, of, expected) in [
            (20.0, "cm", "m", Some("0.2")),
            (36.0, "km/h", "m/s", Some("10")),
            (3.3, "mm", "m", Some("0.0033")),
            (1.0, "AU", "m", Some("1.495978707e11")),
            (180.0, "deg", "degrees", Some("180")),
            (90.0, "deg", "rad/s", Some("1.570796326795")),
            (5.0, "g", "", Some("0.005")),
            (1.0, "kg", "m", None),
        ] {
            assert_eq!(converted(number, unit, of).as_deref(), expected, "{number} {unit}");
        }
    }

    /// Labels and axes show the units that are asked for.
    #[test]
    fn the_font_has_all_letters_of_units() {
        let font = Typeface::usual().font(Weight::Regular);
        for letter in UNITS.iter().flat_map(|unit| unit.names).flat_map(|name| name.chars()) {
            assert!(font.has(letter), "{letter:?}");
        }
    }
}
