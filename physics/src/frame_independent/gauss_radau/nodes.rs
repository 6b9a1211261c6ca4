//! The nodes of the Gauss–Radau method (the times in a step at which forces are evaluated), and the weights that follow from them.

/// The nodes of Gauss–Radau quadrature with eight points, as fractions of a step. Source: E. Everhart, in *Dynamics of Comets* (1985)
/// 185, table 1.
pub(super) const NODES: [f64; 8] = [
    0.0,
    0.056_262_560_536_922_15,
    0.180_240_691_736_892_36,
    0.352_624_717_113_169_6,
    0.547_153_626_330_555_4,
    0.734_210_177_215_410_5,
    0.885_320_946_839_095_8,
    0.977_520_613_561_287_5,
];

/// The number of coefficients of a slope's polynomial: those of h, h², …, h⁷.
pub(super) const TERMS: usize = 7;

/// The weights of the initial slope and of the seven coefficients.
pub(super) type Weights = [f64; TERMS + 1];

/// The weights of the slope's terms in the change of a value, from the start of a step of length 1 to each node h and to the end: hᵏ/k.
pub(super) const OF_VALUE: [Weights; 9] = weights(false);
/// The weights of the acceleration's terms in the displacement, from the start of a step of length 1 to each node h and to the end:
/// hᵏ⁺¹/(k (k + 1)).
pub(super) const OF_PLACE: [Weights; 9] = weights(true);

const fn weights(of_place: bool) -> [Weights; 9] {
    let mut all = [[0.0; TERMS + 1]; 9];
    let mut node = 0;
    while node < 9 {
        let h = if node < 8 { NODES[node] } else { 1.0 };
        let (mut k, mut power, mut number) = (0, h, 1.0);
        while k <= TERMS {
            all[node][k] = if of_place { power * h / (number * (number + 1.0)) } else { power / number };
            power *= h;
            number += 1.0;
            k += 1;
        }
        node += 1;
    }
    all
}

/// The inverse distances 1 / (hₙ − hⱼ) between two nodes.
pub(super) const PER_DISTANCE: [[f64; 8]; 8] = {
    let mut all = [[0.0; 8]; 8];
    let mut n = 1;
    while n < 8 {
        let mut j = 0;
        while j < n {
            all[n][j] = 1.0 / (NODES[n] - NODES[j]);
            j += 1;
        }
        n += 1;
    }
    all
};

/// The coefficients of the products h (h − h₁) … (h − hₖ) as polynomials in h, beginning with that of h. Source: Everhart, equation 8.
pub(super) const POWERS: [[f64; TERMS]; TERMS] = {
    let mut all = [[0.0; TERMS]; TERMS];
    all[0][0] = 1.0;
    let mut k = 1;
    while k < TERMS {
        all[k] = next_row(&all[k - 1], k, [-NODES[k]; TERMS]);
        k += 1;
    }
    all
};

/// The coefficients of the powers of h as sums of the products h (h − h₁) … (h − hₖ). Source: Everhart, equation 9.
pub(super) const PRODUCTS: [[f64; TERMS]; TERMS] = {
    let [_, nodes @ ..] = NODES;
    let mut all = [[0.0; TERMS]; TERMS];
    all[0][0] = 1.0;
    let mut k = 1;
    while k < TERMS {
        all[k] = next_row(&all[k - 1], k, nodes);
        k += 1;
    }
    all
};

/// Returns row k of a triangular table: the previous row, shifted by one place, plus the entries of the previous row times `factors`.
const fn next_row(before: &[f64; TERMS], k: usize, factors: [f64; TERMS]) -> [f64; TERMS] {
    let mut row = [0.0; TERMS];
    let mut j = 0;
    while j <= k {
        let shifted = if j > 0 { before[j - 1] } else { 0.0 };
        row[j] = shifted + factors[j] * before[j];
        j += 1;
    }
    row
}

/// The binomial coefficients (j + 1 choose k + 1).
pub(super) const BINOMIALS: [[f64; TERMS]; TERMS] = {
    let mut all = [[0.0; TERMS]; TERMS];
    let mut j = 0;
    while j < TERMS {
        let (mut k, mut value) = (0, (j + 1) as f64);
        while k <= j {
            all[j][k] = value;
            value = value * ((j - k) as f64) / ((k + 2) as f64);
            k += 1;
        }
        j += 1;
    }
    all
};

#[cfg(test)]
mod tests {
    use super::*;

    /// The tables of powers and of products must be inverse to each other. Entries of the other tables must have the values computed by
    /// hand.
    #[test]
    #[allow(clippy::needless_range_loop, reason = "matrices have two indices")]
    fn powers_and_products_undo_each_other() {
        for k in 0..TERMS {
            for j in 0..TERMS {
                let sum: f64 = (0..TERMS).map(|i| PRODUCTS[k][i] * POWERS[i][j]).sum();
                assert!((sum - f64::from(u8::from(k == j))).abs() < 1e-14, "{k} {j}: {sum}");
            }
        }
        assert_eq!(BINOMIALS[6], [7.0, 21.0, 35.0, 35.0, 21.0, 7.0, 1.0]);
        assert_eq!(OF_VALUE[8][7], 1.0 / 8.0);
        assert_eq!(OF_PLACE[8][7], 1.0 / 72.0);
    }
}
