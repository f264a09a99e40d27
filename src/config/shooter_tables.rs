//! The tables `[shooter]`, `[shooter.errors]`, `[shooter.correlation]` and `[nominal]`.

use super::diagnostics::{Diagnostic, Problem};
use super::toml_reader::TableReader;
use crate::shooter::{
    Correlation, NominalOverrides, NominalVariable, ReleaseDispersion, ReleaseVariable, Shooter,
};
use crate::units::{Dimension, REV_RAD};
use std::sync::LazyLock;

/// Release height if it is missing or wrong, m.
const PLACEHOLDER_HEIGHT_M: f64 = 2.0;
/// Most backspin if it is missing or wrong, rad/s: no nominal spin is more than this.
const PLACEHOLDER_BACKSPIN_RAD_S: f64 = 20.0 * REV_RAD;

pub(super) fn read_shooter(
    root: &mut TableReader<'_, '_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Shooter {
    let mut table = root.table("shooter", diagnostics);
    let name = table.text("name", diagnostics);
    let height = table.required("release_height", Dimension::Length, diagnostics);
    let backspin = table.required("max_backspin", Dimension::Spin, diagnostics);
    let side_spin = table.quantity("max_side_spin", Dimension::Spin, diagnostics);
    let mut errors = table.table("errors", diagnostics);
    let mut dispersion = read_dispersion(&mut errors, diagnostics);
    errors.report_unknown_keys(diagnostics);
    dispersion.correlation = read_correlation(&mut table, diagnostics);
    table.report_unknown_keys(diagnostics);
    Shooter {
        name: name.unwrap_or_else(|| "shooter".to_owned()),
        release_height_m: height.unwrap_or(PLACEHOLDER_HEIGHT_M),
        max_backspin_rad_s: backspin.unwrap_or(PLACEHOLDER_BACKSPIN_RAD_S),
        max_side_spin_rad_s: side_spin.unwrap_or(0.0),
        dispersion,
    }
}

fn read_dispersion(
    table: &mut TableReader<'_, '_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> ReleaseDispersion {
    // An error in percent is the part that grows with the value.
    let of_speed = grown_error(table, ["c10", "speed"], "c11", diagnostics);
    let of_backspin = grown_error(table, ["c40", "backspin"], "c41", diagnostics);
    let mut required = |keys, dimension| {
        let before = diagnostics.len();
        let value = table.required_as(keys, dimension, diagnostics);
        if matches!(dimension, Dimension::Speed | Dimension::Spin) {
            for diagnostic in &mut diagnostics[before..] {
                if diagnostic.problem != Problem::Other {
                    diagnostic.message += ", or a share such as \"1.5 %\"";
                }
            }
        }
        value.unwrap_or(0.0)
    };
    let c10_m_s = match of_speed {
        Some(_) => 0.0,
        None => required(["c10", "speed"], Dimension::Speed),
    };
    let c20_rad = required(["c20", "pitch"], Dimension::Angle);
    let c30_rad = required(["c30", "polar"], Dimension::Angle);
    let c40_rad_s = match of_backspin {
        Some(_) => 0.0,
        None => required(["c40", "backspin"], Dimension::Spin),
    };
    let mut optional = |key, dimension| table.quantity(key, dimension, diagnostics).unwrap_or(0.0);
    ReleaseDispersion {
        c10_m_s,
        c11: of_speed.unwrap_or_else(|| optional("c11", Dimension::Number)),
        c12_s_m: optional("c12", Dimension::PerSpeed),
        c20_rad,
        c30_rad,
        c40_rad_s,
        c41: of_backspin.unwrap_or_else(|| optional("c41", Dimension::Number)),
        c42_s_rad: optional("c42", Dimension::PerSpin),
        rifle_spin_rad_s: optional("rifle_spin", Dimension::Spin),
        side_spin_rad_s: optional("side_spin", Dimension::Spin),
        distance_m: optional("distance", Dimension::Length),
        court_angle_rad: optional("court_angle", Dimension::Angle),
        height_m: optional("height", Dimension::Length),
        correlation: Correlation::NONE,
    }
}

/// The growth `c11` or `c41` of an error, where the error itself is written in percent of its value
/// (`speed = "1.5 %"`), or is left out beside the growth.
fn grown_error(
    table: &mut TableReader<'_, '_>,
    names: [&'static str; 2],
    growth: &'static str,
    diagnostics: &mut Vec<Diagnostic>,
) -> Option<f64> {
    if let Some(share) = table.percentage_as(names) {
        if table.has(growth) {
            let message = format!(
                "is given twice: {} in percent and {growth} are the same",
                names[1]
            );
            diagnostics.push(table.diagnostic(growth, message));
            table.quantity(growth, Dimension::Number, &mut Vec::new());
        }
        return Some(share);
    }
    let is_left_out = !names.iter().any(|name| table.has(name));
    let share = is_left_out
        .then(|| table.quantity(growth, Dimension::Number, &mut Vec::new()))
        .flatten();
    // Without any growth the error itself is missing.
    share.filter(|share| *share != 0.0)
}

/// `[shooter.correlation]`: keys such as `speed_pitch`, each a number from -1 to 1.
fn read_correlation(
    shooter: &mut TableReader<'_, '_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> Correlation {
    let mut table = shooter.table("correlation", diagnostics);
    let mut pairs = Vec::new();
    for (a, b, key) in PAIRS.iter() {
        let twice = PAIRS.iter().find(|(c, d, _)| (c, d) == (b, a));
        if let Some((_, _, other)) = twice
            && *a < *b
            && table.has(key)
            && table.has(other)
        {
            let message = format!("is given twice: {key} and {other} are the same");
            diagnostics.push(table.diagnostic(other, message));
        }
        match table.quantity(key, Dimension::Number, diagnostics) {
            Some(value) if (-1.0..=1.0).contains(&value) => pairs.push((*a, *b, value)),
            Some(_) => diagnostics.push(table.diagnostic(key, "must be from -1 to 1")),
            None => {}
        }
    }
    let correlation = Correlation::new(&pairs);
    let impossible = correlation.is_none().then(|| {
        let least = Correlation::least_eigenvalue(&pairs);
        table.table_diagnostic(format!(
            "these coefficients are impossible together: the matrix of correlations is not positive semi-definite (its least eigenvalue is {least:.3})"
        ))
    });
    table.report_unknown_keys(diagnostics);
    diagnostics.extend(impossible);
    correlation.unwrap_or(Correlation::NONE)
}

/// The keys of `[shooter.correlation]` with their two variables, in either order.
static PAIRS: LazyLock<Vec<(ReleaseVariable, ReleaseVariable, &'static str)>> =
    LazyLock::new(|| {
        let mut pairs = Vec::new();
        for a in ReleaseVariable::ALL {
            for b in ReleaseVariable::ALL.into_iter().filter(|b| *b != a) {
                // 72 short names, once in the life of the program.
                let key: &'static str = format!("{}_{}", a.name(), b.name()).leak();
                pairs.push((a, b, key));
            }
        }
        pairs
    });

/// `[nominal]`: the nominal values that are fixed.
pub(super) fn read_nominal(
    root: &mut TableReader<'_, '_>,
    diagnostics: &mut Vec<Diagnostic>,
) -> NominalOverrides {
    let mut table = root.table("nominal", diagnostics);
    let mut read = |variable: NominalVariable| {
        table.quantity(variable.name(), variable.dimension(), diagnostics)
    };
    let overrides = NominalOverrides {
        speed_m_s: read(NominalVariable::Speed),
        pitch_rad: read(NominalVariable::Pitch),
        polar_rad: read(NominalVariable::Polar),
        backspin_rad_s: read(NominalVariable::Backspin),
        rifle_spin_rad_s: read(NominalVariable::RifleSpin),
        side_spin_rad_s: read(NominalVariable::SideSpin),
    };
    table.report_unknown_keys(diagnostics);
    overrides
}

#[cfg(test)]
mod tests {
    use crate::config::parse_profile;

    const PROFILE: &str = "\
[shooter]
release_height = \"7 ft\"
max_backspin = \"3 rev/s\"
[shooter.errors]
speed = \"0.25 ft/s\"
pitch = \"1.2 deg\"
polar = \"1.2 deg\"
backspin = \"0.3 rev/s\"
[location]
distance = \"12 ft\"
angle = \"0 deg\"
";

    #[test]
    fn contract_an_error_in_percent_grows_with_the_value() {
        let percent = PROFILE
            .replace("0.25 ft/s", "1.5 %")
            .replace("0.3 rev/s", "5 percent");
        let percent = parse_profile(&percent, "a").unwrap();
        let written = PROFILE
            .replace("speed = \"0.25 ft/s\"", "c10 = \"0 ft/s\"\nc11 = 0.015")
            .replace("backspin = \"0.3 rev/s\"", "c41 = \"5 %\"");
        let written = parse_profile(&written, "b").unwrap();
        assert_eq!(percent.shooter().dispersion, written.shooter().dispersion);
        let both = PROFILE.replace("speed =", "c10 = \"1 %\"\nspeed =");
        let error = parse_profile(&both, "d").unwrap_err();
        assert!(error.to_string().contains("c10 and speed are the same"));
        let twice = PROFILE.replace("\"0.25 ft/s\"", "\"1 %\"\nc11 = 0.01");
        let error = parse_profile(&twice, "c").unwrap_err();
        assert!(
            error
                .to_string()
                .contains("speed in percent and c11 are the same")
        );
    }

    #[test]
    fn contract_a_misspelt_key_is_one_error_at_its_line() {
        for (from, to, words) in [
            ("pitch =", "pich =", "did you mean \"pitch\"?"),
            ("polar =", "left_right =", "did you mean \"polar\"?"),
            (
                "[shooter.errors]",
                "[shooter.error]",
                "did you mean \"errors\"?",
            ),
            (
                "max_backspin = \"3",
                "max_backspin = \"3 x",
                "is not a unit",
            ),
        ] {
            let text = PROFILE.replace(from, to) + "[nominal]\nbackspin = \"2 rev/s\"\n";
            let error = parse_profile(&text, "a").unwrap_err();
            assert_eq!(error.diagnostics.len(), 1, "{error}");
            assert!(error.to_string().contains(words), "{error}");
        }
        // A value out of range is marked where it stands.
        let text = PROFILE.replace("polar = \"1.2", "polar = \"-1.2");
        let error = parse_profile(&text, "a").unwrap_err();
        assert_eq!(error.lines_and_columns()[0].0, 7, "{error}");
    }
}
