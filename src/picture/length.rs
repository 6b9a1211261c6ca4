//! Formats lengths with suitable units.

use super::number;
use crate::scene::DecimalSign;

/// Chooses the unit for a length in meters. Returns the length of the unit, m, and its symbol.
pub(super) fn prefixed(length: f64) -> (f64, &'static str) {
    const UNITS: [(f64, &str); 9] = [
        (1e9, "million km"),
        (1e3, "km"),
        (1.0, "m"),
        (1e-2, "cm"),
        (1e-3, "mm"),
        (1e-6, "µm"),
        (1e-9, "nm"),
        (1e-12, "pm"),
        (1e-15, "fm"),
    ];
    // Tenths of a meter are more common than tens of centimeters.
    let fits = |(unit, _): &&(f64, &str)| length >= if *unit == 1.0 { 0.1 } else { unit * 0.999_999 };
    UNITS.iter().find(fits).copied().unwrap_or((1e-15, "fm"))
}

/// Formats a length for a text in the picture, with at most six significant digits.
pub(super) fn value(length: f64, sign: DecimalSign) -> String {
    let mut out = String::new();
    number::write(&mut out, length, 6);
    number::with_sign(number::typeset(&out), sign)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_have_usual_units() {
        for (length, said) in [
            (2.0, "2 m"),
            (0.5, "0.5 m"),
            (0.05, "5 cm"),
            (2e-9, "2 nm"),
            (2e-14, "20 fm"),
            (5e4, "50 km"),
            (1e11, "100 million km"),
        ] {
            let (unit, symbol) = prefixed(length);
            assert_eq!(format!("{} {symbol}", value(length / unit, DecimalSign::Point)), said);
        }
        assert_eq!(value(0.5, DecimalSign::Comma), "0,5");
    }
}
