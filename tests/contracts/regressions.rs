//! Values that must not change. A change of any of them must be listed in CHANGELOG.md with its
//! size.
//!
//! Authority: version 0.1.0 before its modules were renamed. The values are the same on every
//! machine and on every instruction set.

use crate::common::{
    free_throw_uniform, grid, guard_on_the_wing, load, nominal, verdicts, wild, with_search,
};
use bankshot::best_shot::{self, BestShot};
use bankshot::dynamics::{Release, Simulator};
use bankshot::model::{Physics, SolidId};
use bankshot::probability::{Sampler, Silent};
use bankshot::shooter::NominalVariable;

/// Paper's physics: free throws, wild shots. Restitution 0.95: the same.
const VERDICTS: [u64; 4] = [
    0x273b_b4fa_dbcd_11a7,
    0x27b3_1288_f3f9_5fba,
    0x6411_cd89_fa20_d529,
    0xf7b8_8bb3_c342_470a,
];

/// P 0.695556640625, 0.598876953125, 0.62860107421875.
const PROBABILITIES: [u64; 3] = [
    0x3fe6_4200_0000_0000,
    0x3fe3_2a00_0000_0000,
    0x3fe4_1d80_0000_0000,
];

/// Speed, pitch angle, polar angle, backspin and P: direct, bank.
const BEST_SHOTS: [[u64; 5]; 2] = [
    [
        0x401b_86ab_bfb6_c065,
        0x3fef_a564_81f9_4696,
        0x3feb_efb7_8146_177b,
        0x4032_d97c_7f33_21d2,
        0x3fe6_bd00_0000_0000,
    ],
    [
        0x401c_b575_2086_767b,
        0x3fee_772e_36a9_b2fd,
        0x3fe8_f104_4794_b9e7,
        0x4032_d97c_7f33_21d2,
        0x3fe7_9280_0000_0000,
    ],
];

/// FNV-1a, 64 bits.
struct Fnv(u64);

impl Fnv {
    const fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

/// The hash of the verdicts of a sample: made, time, and number of contacts with each solid.
fn hash(physics: &Physics, releases: &[Release]) -> u64 {
    let mut fnv = Fnv::new();
    for verdict in verdicts(&Simulator::new(physics).unwrap(), releases) {
        fnv.add(&[u8::from(verdict.made)]);
        fnv.add(&verdict.time_s.to_bits().to_le_bytes());
        for solid in [SolidId::Board, SolidId::Ring] {
            fnv.add(&verdict.contacts.count_of(solid).to_le_bytes());
        }
    }
    fnv.0
}

#[test]
fn regress_verdicts() {
    let free_throws = free_throw_uniform(20_000, 101);
    let wild = wild(20_000, 102);
    let lively = Physics::with_restitution(0.95).unwrap();
    let found = [
        hash(&Physics::paper(), &free_throws),
        hash(&Physics::paper(), &wild),
        hash(&lively, &free_throws),
        hash(&lively, &wild),
    ];
    println!("{found:#018x?}");
    assert_eq!(found, VERDICTS);
}

#[test]
fn regress_probabilities() {
    let free_throw = load("free_throw");
    let nine_errors = load("errors_in_all_nine_variables");
    let found = [
        (&free_throw, nominal(23.6, 53.5, 0.0, 3.0)),
        (&free_throw, nominal(24.97, 54.2, 0.0, 3.0)),
        (&nine_errors, nominal(23.6, 53.5, 0.0, 3.0)),
    ]
    .map(|(profile, shot)| {
        let estimate = Sampler::new(profile).estimate(&shot, 0.002, 5, &Silent);
        println!("P {}", estimate.probability);
        estimate.probability.to_bits()
    });
    println!("{found:#018x?}");
    assert_eq!(found, PROBABILITIES);
}

/// The bits of speed, pitch angle, polar angle and backspin, and of P.
fn bits(shot: &BestShot) -> [u64; 5] {
    use NominalVariable::{Backspin, Pitch, Polar, Speed};
    let [speed, pitch, polar, backspin] =
        [Speed, Pitch, Polar, Backspin].map(|variable| shot.nominal.get(variable).to_bits());
    let p = shot.estimate.probability;
    println!("{:?} P {p}", shot.nominal);
    [speed, pitch, polar, backspin, p.to_bits()]
}

#[test]
fn regress_best_shots() {
    let profile = with_search(&guard_on_the_wing(), grid(24, 16, 16, 6), 0.004);
    let best = best_shot::find(&profile, &Silent).unwrap();
    let found = [bits(&best.direct.unwrap()), bits(&best.bank.unwrap())];
    println!("{found:#018x?}");
    assert_eq!(found, BEST_SHOTS);
}
