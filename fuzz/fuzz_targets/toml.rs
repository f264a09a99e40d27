//! Profiles, physics files, sweeps and tables of places. The first byte says which.
#![no_main]

use bankshot::config::{parse_locations, parse_physics, parse_profile};
use bankshot::sweep::sweep_toml::{SourceTexts, named_files, parse_sweep};
use libfuzzer_sys::fuzz_target;

const SHOOTER: &str = include_str!("../../configs/free_throw.toml");
const PLACES: &str = "name,x_ft,y_ft\nelbow,11,8\n";

fuzz_target!(|bytes: &[u8]| {
    let Some((which, bytes)) = bytes.split_first() else {
        return;
    };
    let text = String::from_utf8_lossy(bytes).into_owned();
    match which % 4 {
        0 => match parse_profile(&text, "profile") {
            Ok(profile) => assert!(profile.settings().errors().is_empty()),
            Err(error) => assert!(!error.to_string().is_empty()),
        },
        1 => {
            if let Err(error) = parse_physics(&text, "physics") {
                assert!(!error.to_string().is_empty());
            }
        }
        2 => {
            let files = named_files(&text);
            let texts = SourceTexts {
                shooter: files.shooter.map(|_| SHOOTER.to_owned()),
                places: files.places.map(|_| PLACES.to_owned()),
                sweep: text,
            };
            match parse_sweep(&texts, "sweep") {
                Ok(config) => assert!(!config.places.is_empty()),
                Err(error) => assert!(!error.to_string().is_empty()),
            }
        }
        _ => {
            if let Ok(places) = parse_locations(&text) {
                let names = places.names.len();
                assert!(names == 0 || names == places.points_m.len());
            }
        }
    }
});
