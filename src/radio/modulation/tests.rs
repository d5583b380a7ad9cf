use proptest::prelude::*;

use super::*;

/// All that have a form of their own.
pub(super) const ALL: [Modulation; 14] = [
    Modulation::OQpsk,
    Modulation::Dsss1,
    Modulation::Dsss2,
    Modulation::Cck5,
    Modulation::Cck11,
    Modulation::Ofdm6,
    Modulation::Ofdm9,
    Modulation::Ofdm12,
    Modulation::Ofdm18,
    Modulation::Ofdm24,
    Modulation::Ofdm36,
    Modulation::Ofdm48,
    Modulation::Ofdm54,
    Modulation::Gfsk,
];

/// Bit error rates at whole dB from the second entry on, computed from the same forms by another program with forty digits.
const RATES: [(Modulation, i16, &[f64]); 14] = [
    (
        Modulation::OQpsk,
        -8,
        &[
            0.2287612755,
            0.1752462089,
            0.1222103788,
            0.07517156409,
            0.03916345993,
            0.01641863778,
            0.005196999567,
            0.001148943716,
            0.0001615266879,
            1.291186626e-5,
            5.131392089e-7,
            8.597191275e-9,
            4.927505058e-11,
            7.386009413e-14,
            2.053438837e-17,
            6.85132994e-22,
            1.584640267e-27,
        ],
    ),
    (
        Modulation::Dsss1,
        -16,
        &[
            0.2877215245,
            0.2493623384,
            0.2082568811,
            0.1660013938,
            0.1247737304,
            0.08710253449,
            0.05540157918,
            0.03134241188,
            0.01529985077,
            0.006202987343,
            0.001990643492,
            0.0004759689043,
            7.857123183e-5,
            8.135557242e-6,
            4.682756311e-7,
            1.286998032e-8,
            1.394734046e-10,
        ],
    ),
    (
        Modulation::Dsss2,
        -9,
        &[
            0.1528969916,
            0.1104533132,
            0.07556824379,
            0.04827975607,
            0.02829807248,
            0.01488065647,
            0.006825877872,
            0.002636358012,
            0.0008200124132,
            0.0001942047832,
            3.263414036e-5,
            3.560166028e-6,
            2.254634079e-7,
            7.200015734e-9,
        ],
    ),
    (
        Modulation::Cck5,
        -8,
        &[
            0.1775354445,
            0.1483662274,
            0.1193145484,
            0.09139433636,
            0.06579176346,
            0.04372582977,
            0.02620853081,
            0.01373895516,
            0.006054462612,
            0.002133760499,
            0.0005657024831,
            0.0001048176365,
            1.242685967e-5,
            8.468245483e-7,
            2.903006557e-8,
            4.228715889e-10,
            2.110028909e-12,
        ],
    ),
    (
        Modulation::Cck11,
        -5,
        &[
            0.1778335513,
            0.1486676218,
            0.119609931,
            0.09167222955,
            0.06603945739,
            0.04393133106,
            0.02636349412,
            0.01384184022,
            0.006112157714,
            0.00215968762,
            0.0005744600491,
            0.0001068788875,
            1.273612587e-5,
            8.734114654e-7,
            3.017796677e-8,
            4.439323165e-10,
            2.242578332e-12,
        ],
    ),
    (
        Modulation::Gfsk,
        -6,
        &[
            0.4409862857,
            0.4268762743,
            0.4097529894,
            0.3891693055,
            0.3647198141,
            0.3361118465,
            0.3032653299,
            0.2664390182,
            0.2263678888,
            0.1843759613,
            0.1424035435,
            0.1028703305,
            0.06831109822,
            0.04079958584,
            0.02132374789,
            0.009421241979,
            0.0033689735,
            0.0009230988438,
            0.000180891502,
            2.324411084e-5,
            1.755811635e-6,
            6.794716076e-8,
            1.132876676e-9,
            6.543762161e-12,
        ],
    ),
    (
        Modulation::Ofdm6,
        1,
        &[
            0.4135039458,
            0.008769210364,
            0.0002442817148,
            7.620246828e-6,
            1.560222696e-7,
            1.499680767e-9,
            5.150286391e-12,
            4.690562307e-15,
        ],
    ),
    (
        Modulation::Ofdm9,
        4,
        &[
            0.2047617573,
            0.004530946654,
            0.0001458373761,
            5.342097121e-6,
            1.314234235e-7,
            1.557870344e-9,
            6.736854866e-12,
        ],
    ),
    (
        Modulation::Ofdm12,
        4,
        &[
            0.429993371,
            0.009118044772,
            0.0002530473003,
            7.90862943e-6,
            1.62947821e-7,
            1.580694387e-9,
            5.494269722e-12,
            5.081333396e-15,
        ],
    ),
    (
        Modulation::Ofdm18,
        7,
        &[
            0.2129725191,
            0.004705836687,
            0.0001508275993,
            5.534585546e-6,
            1.369784325e-7,
            1.638297762e-9,
            7.16910946e-12,
        ],
    ),
    (
        Modulation::Ofdm24,
        11,
        &[
            0.02480466036,
            0.0009571471094,
            4.400454441e-5,
            1.64776847e-6,
            3.579613216e-8,
            3.516721662e-10,
            1.217734352e-12,
        ],
    ),
    (
        Modulation::Ofdm36,
        14,
        &[
            0.04185677408,
            0.001347533974,
            5.939667052e-5,
            2.444301474e-6,
            6.255654428e-8,
            7.52634224e-10,
            3.273210755e-12,
        ],
    ),
    (
        Modulation::Ofdm48,
        18,
        &[
            0.1752361973,
            0.01076832953,
            0.000559055688,
            2.69873835e-5,
            1.035343681e-6,
            2.504958302e-8,
            3.157278686e-10,
            1.711905544e-12,
        ],
    ),
    (
        Modulation::Ofdm54,
        20,
        &[
            0.02488832157,
            0.001044905323,
            5.565324311e-5,
            2.670990869e-6,
            8.117168261e-8,
            1.206958045e-9,
            6.852828695e-12,
        ],
    ),
];

#[test]
fn bit_error_rates_are_those_of_an_independent_program() {
    for (modulation, first, rates) in RATES {
        for (db, &expected) in (first..).zip(rates) {
            let found = modulation.bit_error_rate(from_db(f64::from(db)));
            let error = (found / expected - 1.0).abs();
            assert!(error < 1e-8, "{modulation:?} at {db} dB: {found}, not {expected}");
        }
    }
}

/// The ratios at which standards demand a share of frames lost, to 1e-6 dB.
#[test]
fn required_ratios_are_those_of_an_independent_program() {
    for (modulation, bits, error, expected) in [
        (Modulation::OQpsk, 8 * 26, 0.01, 0.508_708_529),
        (Modulation::OQpsk, 8 * 37, 0.01, 0.645994050),
        (Modulation::Dsss1, 8 * 1024, 0.08, -3.089_145_370),
        (Modulation::Dsss2, 8 * 1024, 0.08, 1.552_931_847),
        (Modulation::Cck5, 8 * 1024, 0.08, 4.082_736_241),
        (Modulation::Cck11, 8 * 1024, 0.08, 7.093_036_198),
        (Modulation::Ofdm36, 8 * 1000, 0.1, 16.484_123_579),
        (Modulation::Ofdm54, 8 * 1000, 0.1, 22.487_208_286),
        (Modulation::Gfsk, 1, 1e-3, 10.944_437_423),
        (Modulation::lora(7), 200, 0.0, -7.5),
        (Modulation::lora(12), 200, 0.0, -20.0),
    ] {
        let found = modulation.required_snr_db(bits, error);
        assert!(
            (found - expected).abs() < 1e-6,
            "{modulation:?}, {bits} bits: {found}, not {expected}"
        );
    }
    assert!(Modulation::None.required_snr_db(200, 0.0) == f64::NEG_INFINITY);
}

#[test]
fn bits_of_equal_power_overlap_survive_as_the_forms_say() {
    // 296 bits at 0 dB over 802.15.4, by an independent program.
    let survive = Modulation::OQpsk.success(1.0, 296);
    assert!((survive - 0.953_309_407).abs() < 1e-6, "{survive}");
    assert!(Modulation::OQpsk.success(0.0, 0) >= 1.0);
    assert!(Modulation::lora(7).success(0.1, 0) >= 1.0);
    assert!(Modulation::lora(7).success(0.1, 1) == 0.0);
    assert!(Modulation::lora(7).success(0.2, 1000) >= 1.0);
}

#[test]
fn no_rate_is_worse_than_guessing_and_none_is_left_without_noise() {
    for modulation in ALL {
        assert!(modulation.bit_error_rate(f64::INFINITY) == 0.0, "{modulation:?}");
        let worst = modulation.bit_error_rate(0.0);
        assert!((0.4..=0.5).contains(&worst), "{modulation:?}: {worst}");
        assert_eq!(modulation.bit_error_rate(-1.0).to_bits(), worst.to_bits());
    }
}

proptest! {
    #[test]
    fn more_signal_never_means_more_errors(
        modulation in prop::sample::select(ALL.to_vec()), db in -40.0..30.0_f64, more in 0.0..3.0_f64,
    ) {
        let [low, high] = [db, db + more].map(|db| modulation.bit_error_rate(from_db(db)));
        prop_assert!(high <= low * (1.0 + 1e-12));
    }

    #[test]
    fn success_is_the_product_of_its_bits(
        modulation in prop::sample::select(ALL.to_vec()), db in -10.0..25.0_f64, first in 0..500_u32, second in 0..500_u32,
    ) {
        let ratio = from_db(db);
        let parts = modulation.success(ratio, first) * modulation.success(ratio, second);
        let whole = modulation.success(ratio, first + second);
        prop_assert!((parts - whole).abs() <= 1e-12);
        let errors = 1.0 - modulation.bit_error_rate(ratio);
        prop_assert!((whole - errors.powi((first + second).cast_signed())).abs() <= 1e-9);
    }
}
