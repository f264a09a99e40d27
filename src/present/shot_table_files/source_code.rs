//! A table of best shots as source that looks a shot up: Java, C++ and Python.
//!
//! Each has one function of distance and court angle, linear between the nodes. It gives NaN
//! outside the table and beside a place without a shot.

use super::notes::{notes, physics_note, shooter_note, what_shots};
use crate::best_shot::{ShotTable, TableShot};
use crate::escape::source_comment;
use crate::shooter::{Profile, ShotKind};
use crate::units::{DEGREE_RAD, REV_RAD, UnitSystem};

/// A programming language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// Java 8 or newer.
    Java,
    /// C++11 or newer, a header.
    Cpp,
    /// Python 3.
    Python,
}

/// The values that a lookup returns: name and value in units of the results.
fn values(units: UnitSystem) -> [(String, fn(&TableShot) -> f64, f64); 10] {
    const SMALLER: fn([f64; 2]) -> f64 = |[below, above]| below.min(above);
    let (long, metre) = units.length();
    [
        (format!("speed_{long}_s"), |s| s.nominal.speed_m_s, metre),
        ("pitch_deg".to_owned(), |s| s.nominal.pitch_rad, DEGREE_RAD),
        ("aim_deg".to_owned(), |s| s.aim_rad, DEGREE_RAD),
        (
            "backspin_rev_s".to_owned(),
            |s| s.nominal.backspin_rad_s,
            REV_RAD,
        ),
        ("probability".to_owned(), |s| s.probability, 1.0),
        ("time_s".to_owned(), |s| s.time_s.unwrap_or(f64::NAN), 1.0),
        (
            "entry_deg".to_owned(),
            |s| s.entry_rad.unwrap_or(f64::NAN),
            DEGREE_RAD,
        ),
        (
            format!("speed_tolerance_{long}_s"),
            |s| SMALLER(s.tolerances[0]),
            metre,
        ),
        (
            "pitch_tolerance_deg".to_owned(),
            |s| SMALLER(s.tolerances[1]),
            DEGREE_RAD,
        ),
        (
            "is_bank".to_owned(),
            |s| f64::from(u8::from(s.kind == ShotKind::Bank)),
            1.0,
        ),
    ]
}

/// Of the last values, tolerances and kind, the smaller one holds between two nodes. (Both nodes
/// of a cell have the same kind.)
const NOT_INTERPOLATED: usize = 3;

/// Words that can be the name of a file, and not of a class or a namespace, in Java or C++.
const TAKEN: [&str; 96] = [
    "abstract",
    "and",
    "asm",
    "assert",
    "auto",
    "bool",
    "boolean",
    "break",
    "byte",
    "case",
    "catch",
    "char",
    "class",
    "compl",
    "concept",
    "const",
    "constexpr",
    "continue",
    "decltype",
    "default",
    "delete",
    "do",
    "double",
    "else",
    "enum",
    "explicit",
    "export",
    "extends",
    "extern",
    "false",
    "final",
    "finally",
    "float",
    "for",
    "friend",
    "goto",
    "if",
    "implements",
    "import",
    "inline",
    "instanceof",
    "int",
    "interface",
    "long",
    "mutable",
    "namespace",
    "native",
    "new",
    "noexcept",
    "not",
    "null",
    "nullptr",
    "operator",
    "or",
    "package",
    "private",
    "protected",
    "public",
    "record",
    "register",
    "requires",
    "return",
    "sealed",
    "short",
    "signed",
    "sizeof",
    "static",
    "std",
    "strictfp",
    "struct",
    "super",
    "switch",
    "synchronized",
    "template",
    "this",
    "throw",
    "throws",
    "transient",
    "true",
    "try",
    "typedef",
    "typeid",
    "typename",
    "union",
    "unsigned",
    "using",
    "var",
    "virtual",
    "void",
    "volatile",
    "wchar_t",
    "while",
    "xor",
    "yield",
    "_",
    "java",
];

/// Whether a Java class can have this name.
#[must_use]
pub fn is_class_name(name: &str) -> bool {
    let begins = |c: char| c.is_ascii_alphabetic() || c == '_';
    name.starts_with(begins)
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
        && !TAKEN.contains(&name)
}

/// The namespace of a C++ header with this file name: letters, digits and single underscores, and
/// no word of the language. Headers of other names then stand side by side in one program.
#[must_use]
pub fn namespace_of(file_stem: &str) -> String {
    let words = file_stem.split(|c: char| !c.is_ascii_alphanumeric());
    let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
    let name = words.join("_");
    if name.starts_with(|c: char| c.is_ascii_alphabetic()) && !TAKEN.contains(&name.as_str()) {
        name
    } else {
        format!("table_{name}").trim_end_matches('_').to_owned()
    }
}

/// The source in a language, with the name of the class (Java) or of the namespace (C++).
#[must_use]
pub fn source_code(
    table: &ShotTable,
    (language, class): (Language, &str),
    (profile, units): (&Profile, UnitSystem),
) -> String {
    let (long, metre) = units.length();
    let list = |values: &[f64], size: f64| {
        let texts: Vec<String> = values.iter().map(|v| format!("{:.6}", v / size)).collect();
        texts.join(", ")
    };
    let nan = match language {
        Language::Java => "Double.NaN",
        Language::Cpp => "std::numeric_limits<double>::quiet_NaN()",
        Language::Python => "math.nan",
    };
    let (open, close) = match language {
        Language::Python => ("[", "]"),
        _ => ("{", "}"),
    };
    let indent = if language == Language::Java {
        "            "
    } else {
        "    "
    };
    let values = values(units);
    let rows: Vec<String> = table
        .shots
        .iter()
        .map(|shot| {
            let cells: Vec<String> = values
                .iter()
                .map(|(_, value, size)| match shot {
                    Some(shot) if value(shot).is_finite() => format!("{:.6}", value(shot) / size),
                    _ => nan.to_owned(),
                })
                .collect();
            format!("{indent}{open}{}{close},\n", cells.join(", "))
        })
        .collect();
    let names: Vec<&str> = values.iter().map(|(name, ..)| name.as_str()).collect();
    let mut about = vec![
        format!(
            "{}; by bankshot {} (configuration {}).",
            what_shots(table.kind),
            env!("CARGO_PKG_VERSION"),
            profile.hash(),
        ),
        shooter_note(table, profile, units),
        physics_note(profile, units),
        format!(
            "{}(distance_{long}, court_angle_deg) gives {}. Without an angle it takes the first.",
            if language == Language::Java {
                "lookUp"
            } else {
                "look_up"
            },
            names
                .iter()
                .enumerate()
                .map(|(k, name)| format!("[{k}] {name}"))
                .collect::<Vec<_>>()
                .join(", ")
        ),
        "The aim is the angle from the line to the hoop's centre, positive to the left.".to_owned(),
        format!("time_s {TIME_IS_NO_LEAD}"),
        "Time and entry angle are those where the ball first falls to the height of the hoop, as if \
         there were no ring; NaN for a shot that meets the ring on its way up. A tolerance is how far speed or pitch can be off, up or down, alone, \
         until the shot first misses; near the ring more shots may go in beyond it. Between two nodes \
         the smaller tolerance of both is given; it is not checked there. is_bank is 1 for a bank \
         shot, 0 for a direct one."
            .to_owned(),
        "NaN outside the table, and beside a place without a shot.".to_owned(),
    ];
    let inside = example_distance(&table.distances_m, metre);
    about.push(example(language, class, (names[0], &inside)));
    about.extend(notes(table, profile, units));
    let comment = |prefix: &str| {
        let options = textwrap::Options::new(100 - prefix.len() - 1);
        let lines = about.iter().flat_map(|line| textwrap::wrap(line, &options));
        lines
            .map(|line| format!("{prefix} {}\n", source_comment(&line)))
            .collect::<String>()
    };
    let template = match language {
        Language::Java => JAVA,
        Language::Cpp => CPP,
        Language::Python => PYTHON,
    };
    let prefix = if language == Language::Python {
        "#"
    } else {
        "//"
    };
    template
        .replace("@CLASS@", class)
        .replace("@DISTANCES@", &list(&table.distances_m, metre))
        .replace("@ANGLES@", &list(&table.angles_rad, DEGREE_RAD))
        .replace("@NAMES@", &constants(language, &names))
        .replace(
            "@ROWS@",
            &match language {
                Language::Java => java_blocks(&rows),
                _ => rows.concat(),
            },
        )
        .replace("@JAVA_ROWS@", &JAVA_ROWS.to_string())
        .replace("@VALUES@", &values.len().to_string())
        .replace("@LINEAR@", &(values.len() - NOT_INTERPOLATED).to_string())
        // The last: a name in it stays as it is.
        .replace("@ABOUT@", &comment(prefix))
}

/// What the time of a shot is not: a robot that moved and led by it missed.
const TIME_IS_NO_LEAD: &str = "is for a launcher that stands still. It is not the lead of one that moves: the air slows the \
     speed that the ball takes over from the launcher too, so speed times time_s leads too far.";

/// A distance inside the table, with few digits.
fn example_distance(distances_m: &[f64], metre: f64) -> String {
    let [first, .., last] = distances_m else {
        return format!("{:.6}", distances_m[0] / metre);
    };
    format!("{:.1}", 0.5 * (first + last) / metre)
}

/// How the source is used: `first` is the name of the first value, `at` a distance.
fn example(language: Language, class: &str, (first, at): (&str, &str)) -> String {
    let index = first.to_uppercase();
    match language {
        Language::Java => format!(
            "Example: double[] shot = {class}.lookUp({at}); double speed = shot[{class}.{index}]; \
             if (!Double.isNaN(speed)) ..."
        ),
        Language::Cpp => format!(
            "Example: const auto shot = {class}::look_up({at}); const double speed = \
             shot[{class}::{index}]; if (!std::isnan(speed)) ..."
        ),
        Language::Python => format!(
            "Example: shot = look_up({at}); speed = shot[{index}]; if not math.isnan(speed): ..."
        ),
    }
}

/// The indices of the values by name.
fn constants(language: Language, names: &[&str]) -> String {
    let constant = |(k, name): (usize, &&str)| {
        let name = name.to_uppercase();
        match language {
            Language::Java => format!("    public static final int {name} = {k};\n"),
            Language::Cpp => format!("constexpr std::size_t {name} = {k};\n"),
            Language::Python => format!("{name} = {k}\n"),
        }
    };
    names.iter().enumerate().map(constant).collect()
}

/// Rows of a block of a Java source: a method may have 64 KiB of code, about 700 rows.
const JAVA_ROWS: usize = 200;

/// Methods that each give a block of rows, and the table of all blocks.
fn java_blocks(rows: &[String]) -> String {
    let mut text = String::new();
    let mut calls = Vec::new();
    for (k, block) in rows.chunks(JAVA_ROWS).enumerate() {
        calls.push(format!("shots{k}()"));
        text += &format!(
            "    private static double[][] shots{k}() {{\n        return new double[][] {{\n{}        }};\n    }}\n\n",
            block.concat()
        );
    }
    text + &format!(
        "    private static final double[][][] BLOCKS = {{{}}};\n",
        calls.join(", ")
    )
}

const JAVA: &str = "\
@ABOUT@public final class @CLASS@ {
@NAMES@
    private static final double[] DISTANCES = {@DISTANCES@};
    private static final double[] ANGLES = {@ANGLES@};

@ROWS@
    private @CLASS@() {}

    public static double[] lookUp(double distance, double angle) {
        double[] result = new double[@VALUES@];
        for (int k = @LINEAR@; k < result.length; k++) result[k] = Double.POSITIVE_INFINITY;
        int d = cell(DISTANCES, distance);
        int a = cell(ANGLES, angle);
        if (d < 0 || a < 0) {
            java.util.Arrays.fill(result, Double.NaN);
            return result;
        }
        double x = part(DISTANCES, d, distance);
        double y = part(ANGLES, a, angle);
        for (int i = 0; i < 2; i++) {
            for (int j = 0; j < 2; j++) {
                double weight = (i == 0 ? 1 - y : y) * (j == 0 ? 1 - x : x);
                if (weight == 0) continue;
                int row = (a + i) * DISTANCES.length + d + j;
                double[] shot = BLOCKS[row / @JAVA_ROWS@][row % @JAVA_ROWS@];
                for (int k = 0; k < @LINEAR@; k++) result[k] += weight * shot[k];
                for (int k = @LINEAR@; k < result.length; k++) result[k] = Math.min(result[k], shot[k]);
            }
        }
        return result;
    }

    public static double[] lookUp(double distance) {
        return lookUp(distance, ANGLES[0]);
    }

    private static int cell(double[] values, double value) {
        if (!(value >= values[0] && value <= values[values.length - 1])) return -1;
        int i = values.length - 1;
        while (values[i] > value) i--;
        return i;
    }

    private static double part(double[] values, int i, double value) {
        return i + 1 < values.length ? (value - values[i]) / (values[i + 1] - values[i]) : 0;
    }
}
";

const CPP: &str = "\
@ABOUT@#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace @CLASS@ {

@NAMES@
constexpr double distances[] = {@DISTANCES@};
constexpr double angles[] = {@ANGLES@};
constexpr double shots[][@VALUES@] = {
@ROWS@};

template <std::size_t N>
static int cell(const double (&values)[N], double value) {
    if (!(value >= values[0] && value <= values[N - 1])) return -1;
    int i = static_cast<int>(N) - 1;
    while (values[i] > value) --i;
    return i;
}

template <std::size_t N>
static double part(const double (&values)[N], int i, double value) {
    return i + 1 < static_cast<int>(N) ? (value - values[i]) / (values[i + 1] - values[i]) : 0.0;
}

static inline std::array<double, @VALUES@> look_up(double distance, double angle = angles[0]) {
    std::array<double, @VALUES@> result{};
    constexpr int count = sizeof(distances) / sizeof(distances[0]);
    const int d = cell(distances, distance), a = cell(angles, angle);
    if (d < 0 || a < 0) {
        result.fill(std::numeric_limits<double>::quiet_NaN());
        return result;
    }
    for (std::size_t k = @LINEAR@; k < result.size(); ++k) {
        result[k] = std::numeric_limits<double>::infinity();
    }
    const double x = part(distances, d, distance), y = part(angles, a, angle);
    for (int i = 0; i < 2; ++i) {
        for (int j = 0; j < 2; ++j) {
            const double weight = (i == 0 ? 1 - y : y) * (j == 0 ? 1 - x : x);
            if (weight == 0) continue;
            const double* shot = shots[(a + i) * count + d + j];
            for (std::size_t k = 0; k < @LINEAR@; ++k) result[k] += weight * shot[k];
            for (std::size_t k = @LINEAR@; k < result.size(); ++k) {
                // A NaN stays, whichever comes first.
                if (shot[k] < result[k] || std::isnan(shot[k])) result[k] = shot[k];
            }
        }
    }
    return result;
}

}  // namespace @CLASS@
";

const PYTHON: &str = "\
@ABOUT@import bisect
import math

@NAMES@
DISTANCES = [@DISTANCES@]
ANGLES = [@ANGLES@]
SHOTS = [
@ROWS@]


def look_up(distance, angle=ANGLES[0]):
    cells = []
    for values, value in ((DISTANCES, distance), (ANGLES, angle)):
        if not values[0] <= value <= values[-1]:
            return [math.nan] * @VALUES@
        i = bisect.bisect_right(values, value) - 1
        last = i + 1 == len(values)
        cells.append((i, 0.0 if last else (value - values[i]) / (values[i + 1] - values[i])))
    (d, x), (a, y) = cells
    result = [0.0] * @LINEAR@ + [math.inf] * (@VALUES@ - @LINEAR@)
    for i, across in ((0, 1 - y), (1, y)):
        for j, along in ((0, 1 - x), (1, x)):
            weight = across * along
            if weight:
                shot = SHOTS[(a + i) * len(DISTANCES) + d + j]
                for k, value in enumerate(shot):
                    if k < @LINEAR@:
                        result[k] += weight * value
                    elif value < result[k] or math.isnan(value):  # a NaN stays
                        result[k] = value
    return result
";

#[cfg(test)]
mod tests {
    use super::*;

    /// A class of a large table compiles: no method has more rows than fit.
    #[test]
    fn contract_a_large_java_table_is_divided() {
        let rows: Vec<String> = (0..2 * JAVA_ROWS + 1)
            .map(|k| format!("{{{k}.0}},\n"))
            .collect();
        let text = java_blocks(&rows);
        assert!(text.contains("BLOCKS = {shots0(), shots1(), shots2()};"));
        let last = text.split("shots2() {").nth(1).unwrap();
        assert_eq!(last.matches(".0}").count(), 1);
        assert_eq!(text.matches(".0}").count(), rows.len());
    }
}
