//! `bankshot new`: a commented file to edit.

use crate::cli::failure::{Failure, code};
use crate::cli::terminal::{print_answer, print_hint, print_remark};
use crate::config::parse_profile;
use crate::escape::{is_control_or_direction, toml_string};
use crate::shooter::{Profile, implausible_values};
use crate::units::{self, Dimension};
use clap::{Args, ValueEnum};
use std::io::{BufRead, Write};
use std::path::{Path, PathBuf};

#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  bankshot new player                    writes player.toml
  bankshot new player --interactive      asks five questions first
  bankshot new robot launcher.toml
  bankshot new sweep my_court.toml")]
pub(crate) struct NewOptions {
    /// What to write.
    pub(crate) what: Template,
    /// The file [default: its name, such as player.toml]; - for standard output.
    pub(crate) file: Option<PathBuf>,
    /// Ask for the main values (player only).
    #[arg(long)]
    pub(crate) interactive: bool,
}

/// The files that can be written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Template {
    /// The profile of a player.
    Player,
    /// A sweep over the court.
    Sweep,
    /// The profile of a launcher.
    Robot,
    /// A ball and a hoop.
    Physics,
}

impl Template {
    fn text(self) -> &'static str {
        match self {
            Self::Player => include_str!("new_templates/player.toml"),
            Self::Sweep => include_str!("new_templates/sweep.toml"),
            Self::Robot => include_str!("new_templates/robot.toml"),
            Self::Physics => include_str!("new_templates/physics.toml"),
        }
    }

    fn file_name(self) -> &'static str {
        match self {
            Self::Player => "player.toml",
            Self::Sweep => "sweep.toml",
            Self::Robot => "robot.toml",
            Self::Physics => "physics.toml",
        }
    }

    /// The command to run next.
    fn next(self, file: &Path) -> String {
        let file = file.display();
        match self {
            Self::Player => format!("bankshot best {file}"),
            Self::Sweep => format!("bankshot plan {file}"),
            Self::Robot => {
                format!(
                    "bankshot table {file} --draft --kind best --pitch '60 deg' --distances '6 ft to 20 ft by 2 ft'"
                )
            }
            Self::Physics => format!("bankshot check PROFILE.toml --physics {file} --details"),
        }
    }
}

pub(crate) fn run(options: &NewOptions) -> Result<u8, Failure> {
    if options.interactive && options.what != Template::Player {
        return Err(Failure::usage("--interactive: only for a player"));
    }
    let file = options
        .file
        .clone()
        .unwrap_or_else(|| PathBuf::from(options.what.file_name()));
    let is_standard_output = file.as_os_str() == "-";
    // Refused before any question is asked.
    if !is_standard_output && file.symlink_metadata().is_ok() {
        return Err(exists(&file));
    }
    let text = if options.interactive {
        ask(&mut std::io::stdin().lock())?
    } else {
        with_name_of_file(options, &file)
    };
    if is_standard_output {
        return print_answer(&text);
    }
    let mut created = match std::fs::File::create_new(&file) {
        Ok(created) => created,
        Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {
            return Err(exists(&file));
        }
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
            let folder = file.parent().unwrap_or(Path::new("."));
            return Err(Failure::usage(format!(
                "{}: there is no folder {}; create it first",
                file.display(),
                folder.display()
            )));
        }
        Err(error) => return Err(Failure::io(file.display(), &error)),
    };
    created
        .write_all(text.as_bytes())
        .map_err(|error| Failure::io(file.display(), &error))?;
    print_hint(&format!(
        "written: {}; edit it, then: {}",
        file.display(),
        options.what.next(&file)
    ));
    Ok(code::DONE)
}

/// The text of the template. A player or a launcher in a file of another name than the template's
/// has that name, so that those of a team differ.
fn with_name_of_file(options: &NewOptions, file: &Path) -> String {
    let text = options.what.text();
    let is_named = matches!(options.what, Template::Player | Template::Robot);
    let stem = file.file_stem().map(|stem| stem.to_string_lossy());
    match stem {
        Some(name)
            if is_named
                && file.as_os_str() != "-"
                && !file.ends_with(options.what.file_name())
                && !name.contains(is_control_or_direction) =>
        {
            with_value(text, "name = ", &name)
        }
        _ => text.to_owned(),
    }
}

fn exists(file: &Path) -> Failure {
    Failure::usage(format!(
        "{}: exists already; name another file",
        file.display()
    ))
}

/// A question: what is asked, the usual answer, and the key that the answer is the value of.
struct Question {
    words: &'static str,
    usual: &'static str,
    /// The line of the template, up to its value.
    line: &'static str,
    /// `None` for a name.
    dimension: Option<Dimension>,
}

const QUESTIONS: [Question; 4] = [
    Question {
        words: "Name of the player",
        usual: "my player",
        line: "name = ",
        dimension: None,
    },
    Question {
        words: "How high is the ball as it leaves the hand",
        usual: "6 ft 11 in",
        line: "release_height = ",
        dimension: Some(Dimension::Length),
    },
    Question {
        words: "How far from the hoop",
        usual: "13 ft 9 in",
        line: "distance = ",
        dimension: Some(Dimension::Length),
    },
    Question {
        words: "At what angle (0 deg is straight in front, 90 deg the baseline on the right)",
        usual: "0 deg",
        line: "angle = ",
        dimension: Some(Dimension::Angle),
    },
];

/// How steady a player is, with the scatter of speed, pitch and polar angle: those of the files in
/// configs/.
const LEVELS: [(&str, [&str; 3]); 4] = [
    ("novice", ["0.44 ft/s", "2.7 deg", "1.46 deg"]),
    ("school", ["0.30 ft/s", "1.2 deg", "1.22 deg"]),
    ("college", ["0.25 ft/s", "1.2 deg", "1.22 deg"]),
    ("elite", ["0.15 ft/s", "1.2 deg", "0.8 deg"]),
];

/// Asks for the values of a player. An empty answer is the usual one.
fn ask(input: &mut impl BufRead) -> Result<String, Failure> {
    let mut text = Template::Player.text().to_owned();
    for question in &QUESTIONS {
        let answer = answer_to(input, question.words, question.usual, |answer| {
            if let Some(dimension) = question.dimension {
                units::parse(answer, dimension).map_err(|error| error.to_string())?;
            }
            profile_with(&text, &[(question.line, answer)]).map(drop)
        })?;
        text = with_value(&text, question.line, &answer);
    }
    let names = LEVELS.map(|(name, _)| name).join(", ");
    let words = format!(
        "How steady are they: {names}; or your own scatter in speed, release angle, and left and right, such as {}",
        LEVELS[2].1.join(", ")
    );
    let answer = answer_to(input, &words, "college", |answer| {
        let values = scatter_of(answer)
            .ok_or_else(|| format!("one of {names}, or three values with commas between"))?;
        let lines = SCATTER_LINES
            .into_iter()
            .zip(values.iter().map(String::as_str));
        profile_with(&text, &lines.collect::<Vec<_>>()).map(drop)
    })?;
    let values = scatter_of(&answer).unwrap_or_default();
    for (line, value) in SCATTER_LINES.into_iter().zip(&values) {
        text = with_value(&text, line, value);
    }
    let profile: Result<Profile, _> = parse_profile(&text, "the answers");
    for warning in implausible_values(&profile?) {
        print_remark(&format!("warning: {warning}"));
    }
    Ok(text)
}

/// The lines of the scatter in speed, pitch and polar angle, up to their values.
const SCATTER_LINES: [&str; 3] = ["speed = ", "pitch = ", "polar = "];

/// The scatter of a level by name, or three values.
fn scatter_of(answer: &str) -> Option<Vec<String>> {
    let level = LEVELS
        .iter()
        .find(|(name, _)| name.eq_ignore_ascii_case(answer));
    if let Some((_, values)) = level {
        return Some(values.map(str::to_owned).to_vec());
    }
    let values: Vec<String> = answer
        .split(',')
        .map(|value| value.trim().to_owned())
        .collect();
    (values.len() == SCATTER_LINES.len()).then_some(values)
}

/// The profile with other values in some lines of its text.
fn profile_with(text: &str, values: &[(&str, &str)]) -> Result<Profile, String> {
    let text = values.iter().fold(text.to_owned(), |text, (line, value)| {
        with_value(&text, line, value)
    });
    parse_profile(&text, "the answers").map_err(|error| {
        let first = error.diagnostics.first();
        first.map_or_else(
            || error.to_string(),
            |first| format!("{}: {}", first.key, first.message),
        )
    })
}

/// Asks until the answer makes sense.
fn answer_to(
    input: &mut impl BufRead,
    words: &str,
    usual: &str,
    check: impl Fn(&str) -> Result<(), String>,
) -> Result<String, Failure> {
    loop {
        print_remark(&format!("{words}? [{usual}]"));
        let mut line = String::new();
        let read = input
            .read_line(&mut line)
            .map_err(|error| Failure::io("standard input", &error))?;
        if read == 0 {
            return Err(Failure::usage(
                "the input ended before all questions were answered; nothing was written",
            ));
        }
        let answer = match line.trim() {
            "" => usual,
            answer => answer,
        };
        match check(answer) {
            Ok(()) => return Ok(answer.to_owned()),
            Err(error) => print_remark(&error),
        }
    }
}

/// The text with another value, as a TOML string, in the first line that starts so. Its comment
/// stays.
fn with_value(text: &str, start: &str, value: &str) -> String {
    let mut is_done = false;
    let lines = text.lines().map(|line| {
        if is_done || !line.starts_with(start) {
            return format!("{line}\n");
        }
        is_done = true;
        let comment = line.find("  #").map_or("", |at| line[at..].trim_start());
        format!("{:<35}{comment}", format!("{start}{}", toml_string(value)))
            .trim_end()
            .to_owned()
            + "\n"
    });
    lines.collect()
}
