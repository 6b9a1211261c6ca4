//! Colors that follow a quantity, such as the speed of each body.

use super::value_map::part_of;
use super::{Color, Corner, MeasureFormula};

/// A color map: it gives each body of its materials a color by the value of a quantity of this body.
#[derive(Clone, Debug)]
pub struct ColorMap {
    /// The quantity. A measure of [each](super::Subject::Each) body is that of the body that gets the color.
    pub of: MeasureFormula,
    /// The colors of the values.
    pub palette: Palette,
    /// The values of the first and the last color, in the unit of the formula. `None` for the lowest and the highest value of the run.
    pub range: Option<[f64; 2]>,
    /// The title of the color bar.
    pub title: String,
    /// The corner of the color bar in the picture. `None` if the bar is not drawn.
    pub bar: Option<Corner>,
}

impl ColorMap {
    /// The number of colors of a map. More could not be told apart; fewer would be seen as steps.
    pub const COLORS: usize = 256;
    /// The color of a value that is not finite, such as a quotient by 0.
    pub const UNDEFINED: Color = Color([0.5; 3]);

    /// Returns the index of the color of a value, given the values of the first and the last color. Values outside of this range get the
    /// color of its nearer end. `None` if the value is not finite.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the index is from 0 to 255")]
    #[allow(clippy::cast_precision_loss, reason = "there are few colors")]
    pub fn color_of(value: f64, range: [f64; 2]) -> Option<usize> {
        let colors = ColorMap::COLORS as f64;
        part_of(value, range).map(|part| (part * colors).min(colors - 1.0) as usize)
    }
}

/// The sequence of colors of a color map: colors at equal distances, at least two. Between them, colors are mixed.
#[derive(Clone, Debug, PartialEq)]
pub struct Palette(Vec<Color>);

/// The name, the colors as `0xrrggbb`, and the meaning of a palette.
type NamedPalette = (&'static str, &'static [u32], &'static str);

impl Palette {
    /// All named palettes. Sources: viridis, plasma, inferno and magma by S. van der Walt & N. Smith (2015), cividis by J. Nuñez et al., PLoS ONE
    /// 13 (2018) e0199239, turbo by A. Mikhailov (2019), each 17th part as in matplotlib, where colors between differ by less than 0.05;
    /// the others by C. Brewer, colorbrewer2.org.
    pub const NAMED: [NamedPalette; 9] = [
        (
            "viridis",
            &[
                0x44_01_54, 0x48_18_6a, 0x47_2d_7b, 0x42_40_86, 0x3b_52_8b, 0x33_63_8d, 0x2c_72_8e,
                0x26_82_8e, 0x21_91_8c, 0x1f_a0_88, 0x28_ae_80, 0x3f_bc_73, 0x5e_c9_62, 0x84_d4_4b,
                0xad_dc_30, 0xd8_e2_19, 0xfd_e7_25,
            ],
            "From violet over green to yellow",
        ),
        (
            "plasma",
            &[
                0x0d_08_87, 0x31_05_97, 0x4c_02_a1, 0x66_00_a7, 0x7e_03_a8, 0x95_11_a1, 0xaa_23_95,
                0xbc_35_87, 0xcc_47_78, 0xda_5a_6a, 0xe6_6c_5c, 0xf0_80_4e, 0xf8_95_40, 0xfd_ac_33,
                0xfd_c5_27, 0xf8_df_25, 0xf0_f9_21,
            ],
            "From blue over red to yellow",
        ),
        (
            "inferno",
            &[
                0x00_00_04, 0x0b_07_24, 0x21_0c_4a, 0x3d_09_65, 0x57_10_6e, 0x71_19_6e, 0x8a_22_6a,
                0xa3_2c_61, 0xbc_37_54, 0xd2_46_44, 0xe4_5a_31, 0xf1_73_1d, 0xf9_8e_09, 0xfc_ac_11,
                0xf9_cb_35, 0xf2_ea_69, 0xfc_ff_a4,
            ],
            "From black over red to pale yellow",
        ),
        (
            "magma",
            &[
                0x00_00_04, 0x0a_08_22, 0x1d_11_47, 0x36_10_6b, 0x51_12_7c, 0x6a_1c_81, 0x83_26_81,
                0x9c_2e_7f, 0xb7_37_79, 0xd0_41_6f, 0xe7_52_63, 0xf5_6b_5c, 0xfc_89_61, 0xfe_a7_72,
                0xfe_c4_88, 0xfd_e2_a3, 0xfc_fd_bf,
            ],
            "From black over violet to pale rose",
        ),
        (
            "cividis",
            &[
                0x00_22_4e, 0x00_2e_6a, 0x1a_38_6f, 0x32_43_6d, 0x43_4e_6c, 0x53_5a_6d, 0x61_65_6f,
                0x6f_70_73, 0x7d_7c_78, 0x8c_88_78, 0x9b_94_76, 0xab_a0_72, 0xbc_ae_6c, 0xcd_bb_63,
                0xde_c9_58, 0xf0_d8_46, 0xfe_e8_38,
            ],
            "From blue to yellow, the same for any color vision",
        ),
        (
            "turbo",
            &[
                0x30_12_3b, 0x40_40_a2, 0x46_6b_e3, 0x42_94_ff, 0x28_bc_eb, 0x18_dd_c2, 0x32_f2_98,
                0x6d_fe_62, 0xa4_fc_3c, 0xcd_ec_34, 0xee_cf_3a, 0xfd_ac_34, 0xfb_7e_21, 0xeb_50_0e,
                0xd0_2f_05, 0xa9_16_01, 0x7a_04_03,
            ],
            "A rainbow; not perceptually uniform",
        ),
        (
            "blues",
            &[
                0xf7_fb_ff, 0xde_eb_f7, 0xc6_db_ef, 0x9e_ca_e1, 0x6b_ae_d6, 0x42_92_c6, 0x21_71_b5,
                0x08_51_9c, 0x08_30_6b,
            ],
            "From white to blue",
        ),
        (
            "red-blue",
            &[
                0x67_00_1f, 0xb2_18_2b, 0xd6_60_4d, 0xf4_a5_82, 0xfd_db_c7, 0xf7_f7_f7, 0xd1_e5_f0,
                0x92_c5_de, 0x43_93_c3, 0x21_66_ac, 0x05_30_61,
            ],
            "From red over white to blue, for values around a middle",
        ),
        (
            "spectral",
            &[
                0x9e_01_42, 0xd5_3e_4f, 0xf4_6d_43, 0xfd_ae_61, 0xfe_e0_8b, 0xff_ff_bf, 0xe6_f5_98,
                0xab_dd_a4, 0x66_c2_a5, 0x32_88_bd, 0x5e_4f_a2,
            ],
            "From red over yellow to blue, for values around a middle",
        ),
    ];

    /// Returns the palette with this name. `None` for an unknown name.
    pub fn named(name: &str) -> Option<Palette> {
        let (_, colors, _) = Palette::NAMED.iter().find(|(known, ..)| *known == name)?;
        Some(Palette(colors.iter().map(|code| Color::from_code(*code)).collect()))
    }

    /// Returns the palette through these colors. `None` for fewer than two.
    pub fn through(colors: Vec<Color>) -> Option<Palette> {
        (colors.len() >= 2).then_some(Palette(colors))
    }

    /// Returns this many colors of the palette, at least two, from the first to the last.
    #[allow(clippy::cast_precision_loss, reason = "there are few colors")]
    pub fn colors(&self, count: usize) -> Vec<Color> {
        let last = (count.max(2) - 1) as f64;
        (0..count).map(|number| between(&self.0, number as f64 / last)).collect()
    }

    /// Returns the color in the middle.
    pub fn middle(&self) -> Color {
        between(&self.0, 0.5)
    }
}

/// Returns the color at a position from 0 to 1 between colors that are evenly spaced. It is mixed in sRGB.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the index is small")]
#[allow(clippy::cast_precision_loss, reason = "there are few colors")]
fn between(colors: &[Color], part: f64) -> Color {
    let steps = colors.len().saturating_sub(1);
    let at = part * steps as f64;
    let first = (at as usize).min(steps.saturating_sub(1));
    let (one, other) = (colors[first], colors[(first + 1).min(steps)]);
    Color(std::array::from_fn(|k| one.0[k] + (at - first as f64) * (other.0[k] - one.0[k])))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Three colors of viridis. Source: matplotlib, `_cm_listed.py`.
    #[test]
    fn viridis_is_that_of_matplotlib() {
        let colors = Palette::named("viridis").unwrap().colors(ColorMap::COLORS);
        let near = |color: Color, [r, g, b]: [f64; 3]| {
            [r, g, b].iter().zip(color.0).all(|(known, found)| (known - found).abs() < 0.01)
        };
        assert_eq!(colors.len(), 256);
        assert!(near(colors[0], [0.267, 0.005, 0.329]), "{:?}", colors[0]);
        assert!(near(colors[128], [0.128, 0.567, 0.551]), "{:?}", colors[128]);
        assert!(near(colors[255], [0.993, 0.906, 0.144]), "{:?}", colors[255]);
    }

    #[test]
    fn values_are_divided_evenly_among_the_colors() {
        let range = [-1.0, 3.0];
        let colors: Vec<Option<usize>> = [-5.0, -1.0, 0.0, 1.0, 2.999_999, 3.0, 9.0, f64::NAN]
            .map(|value| ColorMap::color_of(value, range))
            .to_vec();
        let expected = [Some(0), Some(0), Some(64), Some(128), Some(255), Some(255), Some(255), None];
        assert_eq!(colors, expected);
        assert_eq!(ColorMap::color_of(2.0, [2.0, 2.0]), Some(128), "a range without a width");
    }

    #[test]
    fn colors_of_a_list_are_at_equal_distances() {
        let [black, red] = ["black", "red"].map(|name| Color::parse(name).unwrap());
        let colors = Palette::through(vec![black, red, Color::WHITE]).unwrap().colors(5);
        assert_eq!(colors, [black, Color([0.5, 0.0, 0.0]), red, Color([1.0, 0.5, 0.5]), Color::WHITE]);
    }
}
