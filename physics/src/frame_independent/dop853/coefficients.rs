//! The coefficients of the Runge–Kutta method DOP853, each with the stage that it belongs to.
//!
//! Source: E. Hairer, S. P. Nørsett & G. Wanner, *Solving Ordinary Differential Equations I*, 2nd edition (1993), II.5 and II.10, and the
//! program DOP853 by E. Hairer and G. Wanner.

/// The times of the stages, as fractions of a step.
pub(super) const STAGE_TIMES: [f64; 12] = [
    0.0,
    0.052_600_151_958_767_73,
    0.078_900_227_938_151_6,
    0.118_350_341_907_227_4,
    0.281_649_658_092_772_6,
    0.333_333_333_333_333_3,
    0.25,
    0.307_692_307_692_307_7,
    0.651_282_051_282_051_3,
    0.6,
    0.857_142_857_142_857_1,
    1.0,
];

/// The index of a stage, counted from 0, and the weight of the slope at that stage.
pub(super) type Weight = (usize, f64);

/// The weights of the slopes at earlier stages in the second stage of DOP853.
pub(super) const STAGE_2: [Weight; 1] = [(0, 0.052_600_151_958_767_73)];

/// The weights of the slopes at earlier stages in the third stage of DOP853.
pub(super) const STAGE_3: [Weight; 2] = [(0, 0.019_725_056_984_537_9), (1, 0.059_175_170_953_613_7)];

/// The weights of the slopes at earlier stages in the fourth stage of DOP853.
pub(super) const STAGE_4: [Weight; 2] = [(0, 0.029_587_585_476_806_85), (2, 0.088_762_756_430_420_54)];

/// The weights of the slopes at earlier stages in the fifth stage of DOP853.
pub(super) const STAGE_5: [Weight; 3] =
    [(0, 0.241_365_134_159_266_7), (2, -0.884_549_479_328_286_1), (3, 0.924_834_003_261_792)];

/// The weights of the slopes at earlier stages in the sixth stage of DOP853.
pub(super) const STAGE_6: [Weight; 3] =
    [(0, 0.037_037_037_037_037_035), (3, 0.170_828_608_729_473_86), (4, 0.125_467_687_566_822_42)];

/// The weights of the slopes at earlier stages in the seventh stage of DOP853.
pub(super) const STAGE_7: [Weight; 4] =
    [(0, 0.037_109_375), (3, 0.170_252_211_019_544_05), (4, 0.060_216_538_980_455_96), (5, -0.017_578_125)];

/// The weights of the slopes at earlier stages in the eighth stage of DOP853.
pub(super) const STAGE_8: [Weight; 5] = [
    (0, 0.037_092_000_118_504_79),
    (3, 0.170_383_925_712_239_98),
    (4, 0.107_262_030_446_373_28),
    (5, -0.015_319_437_748_624_402),
    (6, 0.008_273_789_163_814_023),
];

/// The weights of the slopes at earlier stages in the ninth stage of DOP853.
pub(super) const STAGE_9: [Weight; 6] = [
    (0, 0.624_110_958_716_075_7),
    (3, -3.360_892_629_446_941_4),
    (4, -0.868_219_346_841_726),
    (5, 27.592_099_699_446_71),
    (6, 20.154_067_550_477_894),
    (7, -43.489_884_181_069_96),
];

/// The weights of the slopes at earlier stages in the tenth stage of DOP853.
pub(super) const STAGE_10: [Weight; 7] = [
    (0, 0.477_662_536_438_264_34),
    (3, -2.488_114_619_971_667_7),
    (4, -0.590_290_826_836_843),
    (5, 21.230_051_448_181_193),
    (6, 15.279_233_632_882_423),
    (7, -33.288_210_968_984_86),
    (8, -0.020_331_201_708_508_627),
];

/// The weights of the slopes at earlier stages in the eleventh stage of DOP853.
pub(super) const STAGE_11: [Weight; 8] = [
    (0, -0.937_142_430_085_987_3),
    (3, 5.186_372_428_844_064),
    (4, 1.091_437_348_996_729_5),
    (5, -8.149_787_010_746_927),
    (6, -18.520_065_659_996_96),
    (7, 22.739_487_099_350_505),
    (8, 2.493_605_552_679_652_3),
    (9, -3.046_764_471_898_219_6),
];

/// The weights of the slopes at earlier stages in the twelfth stage of DOP853.
pub(super) const STAGE_12: [Weight; 9] = [
    (0, 2.273_310_147_516_538),
    (3, -10.534_495_466_737_25),
    (4, -2.000_872_058_224_862_5),
    (5, -17.958_931_863_118_8),
    (6, 27.948_884_529_419_96),
    (7, -2.858_998_277_135_023_5),
    (8, -8.872_856_933_530_63),
    (9, 12.360_567_175_794_303),
    (10, 0.643_392_746_015_763_6),
];

/// The weights of the slopes in the result of a step.
pub(super) const RESULT_WEIGHTS: [Weight; 8] = [
    (0, 0.054_293_734_116_568_765),
    (5, 4.450_312_892_752_409),
    (6, 1.891_517_899_314_500_3),
    (7, -5.801_203_960_010_585),
    (8, 0.311_164_366_957_819_9),
    (9, -0.152_160_949_662_516_1),
    (10, 0.201_365_400_804_030_34),
    (11, 0.044_710_615_727_772_59),
];

/// The weights of the slopes in the third-order error estimate.
pub(super) const ERROR_3: [Weight; 8] = [
    (0, -0.189_800_754_072_407_62),
    (5, 4.450_312_892_752_409),
    (6, 1.891_517_899_314_500_3),
    (7, -5.801_203_960_010_585),
    (8, -0.422_682_321_323_791_9),
    (9, -0.152_160_949_662_516_1),
    (10, 0.201_365_400_804_030_34),
    (11, 0.022_651_792_198_360_82),
];

/// The weights of the slopes in the fifth-order error estimate.
pub(super) const ERROR_5: [Weight; 8] = [
    (0, 0.013_120_044_994_194_88),
    (5, -1.225_156_446_376_204_4),
    (6, -0.495_758_949_657_250_2),
    (7, 1.664_377_182_454_986_4),
    (8, -0.350_328_848_749_973_66),
    (9, 0.334_179_118_713_017_5),
    (10, 0.081_923_206_485_115_71),
    (11, -0.022_355_307_863_886_294),
];
