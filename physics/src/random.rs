//! Random numbers that are the same on every run and every machine.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use sha2::{Digest, Sha256};

/// A stream of random numbers.
///
/// Each key of a scene has its own stream, which is determined by the scene's seed and the path of the key. Adding anything else to the
/// scene does not change the numbers of a stream.
#[derive(Clone, Debug)]
pub struct Stream(ChaCha8Rng);

impl Stream {
    /// Creates the random stream for a path in a scene, such as `body.ball.location[1]`.
    #[must_use]
    pub fn new(seed: u64, path: &str) -> Stream {
        let mut hash = Sha256::new();
        hash.update(seed.to_le_bytes());
        hash.update(path);
        Stream(ChaCha8Rng::from_seed(hash.finalize().into()))
    }

    /// Returns one of 2⁶⁴ independent streams for the same path. Each starts from its beginning, regardless of the numbers drawn from
    /// `self` so far.
    #[must_use]
    pub fn substream(&self, number: u64) -> Stream {
        let mut substream = self.0.clone();
        substream.set_stream(number);
        substream.set_word_pos(0);
        Stream(substream)
    }

    /// Draws a uniformly distributed number from 0 to 1, excluding 1.
    #[allow(clippy::cast_precision_loss, reason = "53 bits are what a number holds")]
    pub fn uniform(&mut self) -> f64 {
        const SPACING: f64 = 1.0 / (1u64 << 53) as f64;
        (self.0.next_u64() >> 11) as f64 * SPACING
    }

    /// Draws a normally distributed number with mean 0 and standard deviation 1, by the Box–Muller method.
    pub fn normal(&mut self) -> f64 {
        // The argument of the logarithm is never 0, because `uniform` never returns 1.
        let radius = (-2.0 * libm::log(1.0 - self.uniform())).sqrt();
        radius * libm::cos(std::f64::consts::TAU * self.uniform())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_place_has_the_same_numbers_for_ever() {
        let mut stream = Stream::new(0, "body.ball.location[1]");
        let numbers = [stream.uniform(), stream.uniform(), stream.normal()];
        // A short Python program with the rounds of ChaCha8 written out gives the same numbers, up to the last digit of a logarithm.
        assert_eq!(numbers, [0.011158441926262475, 0.6062048921625598, -0.8852880506164754]);
    }

    #[test]
    fn branches_do_not_depend_on_what_was_drawn_before() {
        let mut stream = Stream::new(0, "a");
        let first = |stream: &Stream, number| stream.substream(number).uniform();
        let before = [0, 1, 2].map(|number| first(&stream, number));
        stream.uniform();
        assert_eq!([0, 1, 2].map(|number| first(&stream, number)), before);
        assert!(before[0] != before[1] && before[1] != before[2]);
    }

    #[test]
    fn another_place_or_seed_has_other_numbers() {
        let first = |seed, path| Stream::new(seed, path).uniform();
        let numbers = [first(0, "a"), first(1, "a"), first(0, "b"), first(0, "a[0]")];
        for (i, number) in numbers.iter().enumerate() {
            assert!(numbers[..i].iter().all(|other| other != number), "{numbers:?}");
        }
    }

    #[test]
    fn the_numbers_are_spread_as_they_should_be() {
        const COUNT: u32 = 100_000;
        let mean = |of: &dyn Fn(&mut Stream) -> f64| {
            let mut stream = Stream::new(3, "x");
            (0..COUNT).map(|_| of(&mut stream)).sum::<f64>() / f64::from(COUNT)
        };
        // The tolerance is four standard deviations of the mean: 4 √(variance / COUNT).
        assert!((mean(&Stream::uniform) - 0.5).abs() < 4.0 * 0.289 / 316.0);
        assert!((mean(&|s| s.uniform() * s.uniform()) - 0.25).abs() < 4.0 * 0.22 / 316.0);
        assert!(mean(&Stream::normal).abs() < 4.0 / 316.0);
        let square = |s: &mut Stream| {
            let normal = s.normal();
            normal * normal
        };
        assert!((mean(&square) - 1.0).abs() < 4.0 * 1.42 / 316.0);
        let beyond_two = |s: &mut Stream| f64::from(u8::from(s.normal().abs() > 2.0));
        assert!((mean(&beyond_two) - 0.0455).abs() < 4.0 * 0.21 / 316.0);
    }
}
