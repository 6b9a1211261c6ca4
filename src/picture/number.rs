//! Writes numbers as short decimal texts.

use crate::scene::DecimalSign;

/// The powers of ten that are exact as `f64`.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18,
    1e19, 1e20, 1e21, 1e22,
];

/// Appends a finite number to a text, rounded to `digits` significant digits (1 to 17), without trailing zeros. Zero has no sign.
pub(crate) fn write(out: &mut String, number: f64, digits: usize) {
    debug_assert!(number.is_finite(), "the emitter refuses numbers that are not finite");
    if number == 0.0 {
        out.push('0');
        return;
    }
    if number < 0.0 {
        out.push('-');
    }
    let magnitude = number.abs();
    let (decimals, exponent) = by_arithmetic(magnitude, digits).unwrap_or_else(|| by_text(magnitude, digits));
    layout(out, decimals, exponent, digits);
}

/// Rewrites a number for texts in the picture: `-7.5e-6` becomes `−7.5·10⁻⁶`, with the minus sign `−` in place of the hyphen. A power of
/// ten that is 1 is left out.
pub(super) fn typeset(number: &str) -> String {
    let with_minus = |text: &str| text.replace('-', "−");
    let (digits, exponent) = number.split_once('e').unwrap_or((number, "0"));
    if exponent == "0" {
        return with_minus(digits);
    }
    let raised = |c: char| match c {
        '-' => '⁻',
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        other => other,
    };
    format!("{}·10{}", with_minus(digits), exponent.chars().map(raised).collect::<String>())
}

/// Replaces the decimal point of a number in the picture by the sign that a scene wants.
pub(super) fn with_sign(number: String, sign: DecimalSign) -> String {
    match sign {
        DecimalSign::Point => number,
        DecimalSign::Comma => number.replace('.', ","),
    }
}

/// Returns a number as text, rounded to three significant digits, as messages show it.
pub(crate) fn rounded(number: f64) -> String {
    text(number, 3)
}

/// Returns a number as text, rounded to `digits` significant digits.
pub(crate) fn text(number: f64, digits: usize) -> String {
    let mut out = String::new();
    write(&mut out, number, digits);
    out
}

/// Computes the significant digits as a whole number, and the decimal exponent of the first digit. `None` if floating-point errors might
/// have led to rounding in the wrong direction.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "the exponents of f64 are small, and the scaled number lies within 10^12"
)]
fn by_arithmetic(magnitude: f64, digits: usize) -> Option<(u64, i32)> {
    const MOST_DIGITS: usize = 12;
    if digits > MOST_DIGITS || !(1e-9..1e15).contains(&magnitude) {
        return None;
    }
    // log10(2) is about 1233 / 4096. The estimate of the exponent may be off by one, which is corrected below.
    let binary_exponent = (magnitude.to_bits() >> 52) as i32 - 1023;
    let mut exponent = (binary_exponent * 1233) >> 12;
    let scale = |exponent: i32| {
        let power = digits as i32 - 1 - exponent;
        match power {
            0..=22 => Some(magnitude * POWERS[power as usize]),
            -22..0 => Some(magnitude / POWERS[-power as usize]),
            _ => None,
        }
    };
    let mut scaled = scale(exponent)?;
    if scaled >= POWERS[digits] {
        exponent += 1;
        scaled = scale(exponent)?;
    } else if scaled < POWERS[digits - 1] {
        exponent -= 1;
        scaled = scale(exponent)?;
    }
    let whole = scaled.floor();
    let fraction = scaled - whole;
    // The scaled number has an error of at most one unit in the last place: 10^12 × 2^-52 < 0.0003.
    if (fraction - 0.5).abs() < 0.001 {
        return None;
    }
    let decimals = whole as u64 + u64::from(fraction > 0.5);
    // If the digits were rounded up to the next power of ten, or the estimated exponent is wrong, `exact` is used instead.
    let range = POWERS[digits - 1] as u64..POWERS[digits] as u64;
    range.contains(&decimals).then_some((decimals, exponent))
}

/// Computes the same digits and exponent as [`fast`] by exact decimal arithmetic.
fn by_text(magnitude: f64, digits: usize) -> (u64, i32) {
    let text = format!("{magnitude:.*e}", digits - 1);
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let decimals =
        mantissa.bytes().filter(u8::is_ascii_digit).fold(0, |n, digit| n * 10 + u64::from(digit - b'0'));
    (decimals, exponent.parse().unwrap_or(0))
}

/// Writes digits with a decimal point, without trailing zeros. Numbers from 0.00001 to below 10^10 have no exponent.
fn layout(out: &mut String, mut decimals: u64, exponent: i32, digits: usize) {
    let mut buffer = [b'0'; 20];
    let mut length = digits;
    for slot in buffer[..digits].iter_mut().rev() {
        // The remainder of a division by ten is a digit.
        *slot = b'0' + (decimals % 10) as u8;
        decimals /= 10;
    }
    while length > 1 && buffer[length - 1] == b'0' {
        length -= 1;
    }
    let push = |out: &mut String, bytes: &[u8]| out.extend(bytes.iter().map(|&byte| char::from(byte)));
    match exponent {
        -5..0 => {
            out.push_str("0.");
            (exponent + 1..0).for_each(|_| out.push('0'));
            push(out, &buffer[..length]);
        }
        0..10 => {
            let whole = exponent as usize + 1;
            push(out, &buffer[..whole.min(length)]);
            (length..whole).for_each(|_| out.push('0'));
            if length > whole {
                out.push('.');
                push(out, &buffer[whole..length]);
            }
        }
        _ => {
            push(out, &buffer[..1]);
            if length > 1 {
                out.push('.');
                push(out, &buffer[1..length]);
            }
            out.push('e');
            out.push_str(&exponent.to_string());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_plain() {
        for (number, expected) in [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0, "1"),
            (-2.5, "-2.5"),
            (17.990_000_000_000_002, "17.99"),
            (1.0 / 3.0, "0.333333333"),
            (0.1 + 0.2, "0.3"),
            (1e-5, "0.00001"),
            (1e-6, "1e-6"),
            (-1.5e-7, "-1.5e-7"),
            (123_456_789.4, "123456789"),
            (1_234_567_891.0, "1234567890"),
            (9_999_999_999.0, "1e10"),
            (9.999_999_999, "10"),
            (999_999_999.5, "1000000000"),
            (1e22, "1e22"),
            (f64::MAX, "1.79769313e308"),
            (f64::MIN_POSITIVE, "2.22507386e-308"),
            (5e-324, "4.94065646e-324"),
        ] {
            assert_eq!(text(number, 9), expected, "{number:e}");
        }
        assert_eq!(text(0.1, 17), "0.10000000000000001");
        assert_eq!(text(20_000.0, 4), "20000");
    }

    /// The fast algorithm either agrees with exact decimal arithmetic or returns `None`.
    #[test]
    fn the_fast_way_agrees_with_the_exact_one() {
        let mut bits: u64 = 0x9e37_79b9_7f4a_7c15;
        let mut decided = 0;
        for round in 0..400_000 {
            bits = bits.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            // The exponents are typical of scenes. Every fifth number may lie exactly between two decimal numbers.
            let unit = (bits >> 11) as f64 / (1u64 << 53) as f64;
            let magnitude = libm::pow(10.0, f64::from(round % 26) - 10.0) * (unit + 1e-3);
            let magnitude = if round % 5 == 0 { (magnitude * 2048.0).round() / 2048.0 } else { magnitude };
            for digits in [1, 4, 6, 9, 12] {
                if let Some(fast) = by_arithmetic(magnitude, digits) {
                    decided += 1;
                    assert_eq!(fast, by_text(magnitude, digits), "{magnitude:e} to {digits} digits");
                }
            }
        }
        assert!(decided > 1_000_000, "the fast way decides nearly always, here {decided} times");
    }
}
