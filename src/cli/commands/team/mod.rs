//! `bankshot team`: who should bank from where, and who is best from where.

mod court_results;

use super::plan_sweep_time_and_memory::forecast_s;
use super::sweep::{compute, run_options};
use crate::analysis::sensitivity::{Difference, SensitivityTopics};
use crate::best_shot::{ShotKind, find_kinds};
use crate::cli::config_files::{
    load_profile, read_sweep_without_shooter, read_text, warnings_of_fit,
};
use crate::cli::failure::{Failure, code};
use crate::cli::fit_folder::{self, FitFolder};
use crate::cli::nominal_shot_flags::PlaceOptions;
use crate::cli::plot_files;
use crate::cli::progress_bars::ProgressBars;
use crate::cli::run_folder;
use crate::cli::shooter_folders;
use crate::cli::terminal::{print_answer, print_prose, print_remark, time_in_words};
use crate::cli::value_parsers::PhysicsArg;
use crate::fitting::{UnseenParameter, advise};
use crate::model::SolidId;
use crate::output::atomic_file;
use crate::output::fit_files::advice_text::{advice_for_poster, brief_advice_text};
use crate::plots::player_poster::PlayerPoster;
use crate::plots::svg::shortened;
use crate::plots::sweep_results::SweepResults;
use crate::plots::{player_poster, sweep_bank_direct_map, team_maps};
use crate::probability::{Progress, Sampler, Silent};
use crate::report::poster_page::{poster_page, posters_page};
use crate::shooter::{OutputSettings, Profile, ReleaseVariable, implausible_values};
use crate::sweep::SweepConfig;
use crate::sweep::job_list::Shard;
use crate::sweep::probability_by_place::{PlaceProbabilities, Preference, SURE};
use crate::sweep::result_row::ResultRow;
use crate::sweep::sweep_toml::{is_sweep, parse_sweep};
use crate::units::DEGREE_RAD;
use clap::Args;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use court_results::{
    LONGEST_NAME, PlayerSweep, SIDES_DIFFER, best_players, in_hundred, table_of, team_csv,
    team_page, team_text, whole_percent,
};

#[derive(Args, Debug)]
#[command(after_help = "\
Without --sweep each player shoots from the location of their profile, or all from --distance and --angle, and one table is printed.

With --sweep each player shoots from every place of the sweep; it needs no shooter of its own, and one that it has is left out. \
A region \"places\" takes a list of places with names, from a CSV file. OUT/team.html is a page to look at, OUT/posters.html has a sheet to print for each player, OUT/team.csv has \
every place and player, OUT/team.svg their maps side by side and who is best from where. Each player gets a folder in OUT with the sweep, its map and the poster. Stop it whenever you like; \
the same command continues.

Examples:
  bankshot team ann.toml bo.toml cy.toml
  bankshot team results/season-fit
  bankshot team results/season-fit --place 2
  bankshot team results/season-fit --distance '10 ft' --angle '45 deg'
  bankshot team ann.toml bo.toml cy.toml \\
    --sweep configs/half_court_3ft.toml --plan
  bankshot team ann.toml bo.toml cy.toml \\
    --sweep configs/half_court_3ft.toml --out team")]
pub(crate) struct TeamOptions {
    /// The players' profiles, the folders of their fits, or the folder of a fit of several
    /// shooters.
    #[arg(required = true, num_args = 1..)]
    pub(crate) players: Vec<PathBuf>,
    /// A sweep: its places and its search. Each player takes the place of its shooter.
    #[arg(long, value_name = "SWEEP.toml")]
    pub(crate) sweep: Option<PathBuf>,
    /// Folder of the results of --sweep.
    #[arg(long, value_name = "DIR", default_value = "results/team")]
    pub(crate) out: PathBuf,
    /// Of fits with several places: the number of the place that each player shoots from, 1 for the
    /// first.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..), conflicts_with = "sweep")]
    pub(crate) place: Option<u32>,
    #[command(flatten)]
    pub(crate) from: PlaceOptions,
    /// With --sweep: say how long it takes, and stop.
    #[arg(long, requires = "sweep")]
    pub(crate) plan: bool,
}

pub(crate) fn run(options: &TeamOptions, quiet: bool) -> Result<u8, Failure> {
    match &options.sweep {
        None => from_their_places(options, quiet),
        Some(_) if options.from.is_given() => Err(Failure::usage(
            "--distance and --angle: one place for all players; with --sweep they shoot from its places",
        )),
        Some(sweep) => over_the_court(options, sweep, quiet),
    }
}

/// The files of the profiles: in place of the folder of a fit its profile, and those of all
/// shooters in place of the folder of their fits. With a number of a place those of that place.
fn files_of_players(paths: &[PathBuf], place: Option<u32>) -> Vec<PathBuf> {
    let fits = paths.iter().flat_map(|path| {
        let shooters = shooter_folders::of_shooters(path);
        if shooters.is_empty() {
            vec![path.clone()]
        } else {
            shooters
        }
    });
    fits.map(|path| {
        let number = place.unwrap_or(1) as usize;
        let profile = path.join(fit_folder::profile_file(number - 1));
        if profile.is_file() || (path.is_dir() && place.is_some()) {
            profile
        } else {
            path
        }
    })
    .collect()
}

/// The players' profiles. Each has a name of its own, which is also that of its folder.
fn load_players(
    (paths, place): (&[PathBuf], Option<u32>),
    quiet: bool,
) -> Result<Vec<(PathBuf, Profile)>, Failure> {
    let mut players: Vec<(PathBuf, Profile)> = Vec::new();
    for path in files_of_players(paths, place) {
        if is_sweep(&read_text(&path)?) {
            return Err(Failure::usage(format!(
                "{path}: this is a sweep, not a player; name the players alone, and the sweep with --sweep {path}",
                path = path.display()
            )));
        }
        let player = load_profile(&path, &PhysicsArg::default(), true)?;
        if !quiet {
            let of_fit = warnings_of_fit(&path).into_iter();
            let of_fit = of_fit.map(|words| format!("its fit warned: {words}"));
            for words in implausible_values(&player).into_iter().chain(of_fit) {
                print_remark(&format!("{}: warning: {words}", player.shooter().name));
            }
        }
        let name = &player.shooter().name;
        let folder = run_folder::safe_name(name);
        if players
            .iter()
            .any(|(_, other)| run_folder::safe_name(&other.shooter().name) == folder)
        {
            return Err(Failure::usage(format!(
                "{}: two players have the name \"{name}\"; give each their own",
                path.display()
            )));
        }
        players.push((path, player));
    }
    Ok(players)
}

/// What a player is told about bank and direct.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Verdict {
    Prefer(Preference),
    /// The measured shots leave both open.
    Unsure,
}

impl Verdict {
    const ALL: [Self; 4] = [
        Self::Prefer(Preference::Bank),
        Self::Prefer(Preference::Direct),
        Self::Prefer(Preference::Either),
        Self::Unsure,
    ];

    fn in_words(self) -> &'static str {
        match self {
            Self::Prefer(Preference::Bank) => "Bank it",
            Self::Prefer(Preference::Direct) => "Shoot it direct",
            Self::Prefer(Preference::Either) => "Either is as good",
            Self::Unsure => "Not sure yet, the measured shots leave both open",
        }
    }
}

fn from_their_places(options: &TeamOptions, quiet: bool) -> Result<u8, Failure> {
    let profiles = load_players((&options.players, options.place), quiet)?;
    let has_further_places = |(path, _): &(PathBuf, Profile)| {
        path.ends_with("profile.toml") && path.with_file_name("profile_place_2.toml").is_file()
    };
    if !quiet && options.place.is_none() && profiles.iter().any(has_further_places) {
        print_remark(
            "of fits with several places: each player shoots from the first one; --place 2 takes the second, and --sweep COURT.toml any (a region \"places\" takes a list of them)",
        );
    }
    let header = ["player", "place", "direct", "bank", "shoot it"];
    let mut table = table_of(header.map(str::to_owned).to_vec());
    let bars = ProgressBars::new(quiet);
    let (mut any_either, mut any_draws, mut any_nearly_other) = (false, false, false);
    let mut rows: Vec<(f64, Vec<String>)> = Vec::new();
    let mut verdicts: Vec<(Verdict, String)> = Vec::new();
    for (path, profile) in profiles {
        let profile = &options.from.moved(profile)?;
        let (_, shots) = find_kinds(profile, &ShotKind::ALL, SensitivityTopics::NONE, &bars)?;
        let p: Vec<Option<Difference>> = shots
            .iter()
            .map(|shot| {
                let estimate = &shot.as_ref().ok()?.estimate;
                Some(Difference {
                    value: estimate.probability,
                    standard_error: estimate.standard_error,
                })
            })
            .collect();
        let mut text = |kind: ShotKind| {
            let is_nearly_other = shots[kind.index()]
                .as_ref()
                .is_ok_and(|shot| shot.share_of_other_kind(kind) > 0.5);
            any_nearly_other |= is_nearly_other;
            p[kind.index()].map_or("-".to_owned(), |p| {
                format!(
                    "{} \u{b1} {}{}",
                    in_hundred(p.value),
                    in_hundred(p.standard_error),
                    if is_nearly_other { " *" } else { "" }
                )
            })
        };
        let preference = Preference::of(p[0], p[1]);
        any_either |= preference == Some(Preference::Either);
        let mut advice = preference
            .map_or("no clean shot", Preference::name)
            .to_owned();
        let mut is_sure = true;
        if let [Ok(direct), Ok(bank)] = &shots[..]
            && preference != Some(Preference::Either)
            && let Some(fit) = fit_folder::of_profile(&path)?
        {
            let nominals = [&direct.nominal, &bank.nominal];
            let bank_is_better = fit_folder::bank_is_better(&fit, profile, nominals)?;
            let share = match preference {
                Some(Preference::Bank) => bank_is_better,
                _ => 1.0 - bank_is_better,
            };
            advice += &format!(" ({} %)", whole_percent(share));
            is_sure = share >= SURE;
            any_draws = true;
        }
        let (long, metre) = profile.output().units.length();
        let location = profile.location();
        let name = shortened(&profile.shooter().name, LONGEST_NAME);
        verdicts.extend(preference.map(|preference| {
            let verdict = if is_sure {
                Verdict::Prefer(preference)
            } else {
                Verdict::Unsure
            };
            (verdict, name.clone())
        }));
        let best = p.iter().flatten().map(|p| p.value).fold(0.0, f64::max);
        let row = vec![
            name,
            format!(
                "{:.2} {long},\n{}",
                location.distance_m / metre,
                match location.angle_rad / DEGREE_RAD {
                    angle if angle >= 0.5 => format!("{angle:.0} deg right"),
                    angle if angle <= -0.5 => format!("{:.0} deg left", -angle),
                    _ => "in front".to_owned(),
                }
            ),
            text(ShotKind::Direct),
            text(ShotKind::Bank),
            advice,
        ];
        rows.push((best, row));
    }
    rows.sort_by(|a, b| b.0.total_cmp(&a.0));
    for (_, row) in rows {
        table.add_row(row);
    }
    let mut text = String::new();
    for verdict in Verdict::ALL {
        let told = verdicts.iter().filter(|(of, _)| *of == verdict);
        let names: Vec<&str> = told.map(|(_, name)| name.as_str()).collect();
        if !names.is_empty() {
            text += &format!("{}: {}.\n", verdict.in_words(), names.join(", "));
        }
    }
    text += &format!(
        "\nmakes in 100 of each one's best shot (not of the usual one), the best player first\n{}\n",
        table.trim_fmt()
    );
    if any_either {
        text += "either: the two differ by less than 1 in 100, or by less than twice the error of their difference\n";
    }
    if any_nearly_other {
        text += "*: nearly the other kind: more than half of the makes of this bank shot do not touch the board first, or of this direct one do\n";
    }
    text += "\u{b1}: numerical; each profile is taken as exact (`bankshot advise` says how sure the P of a measured player is)\n";
    if any_draws {
        text += "in brackets: in how many of 100 draws of the fit this kind is the better one; from 90 on it is sure\n";
    }
    print_prose(&text)
}

fn over_the_court(options: &TeamOptions, sweep: &Path, quiet: bool) -> Result<u8, Failure> {
    let texts = read_sweep_without_shooter(sweep)?;
    // Every profile is read before anything is computed.
    let mut sweeps = Vec::new();
    let mut folders: Vec<PathBuf> = Vec::new();
    let players = load_players((&options.players, None), quiet)?;
    let mut warnings = String::new();
    for (path, player) in players {
        for words in warnings_of_fit(&path) {
            warnings += &format!("{}: the fit warned: {words}.\n", player.shooter().name);
        }
        let mut texts = texts.clone();
        texts.shooter = Some(read_text(&path)?);
        let config = parse_sweep(&texts, &sweep.display().to_string())?;
        let name = player.shooter().name.clone();
        folders.push(options.out.join(run_folder::safe_name(&name)));
        let fit = fit_folder::of_profile(&path)?;
        sweeps.push((name, fit, config, texts));
    }
    if options.plan {
        return print_answer(&match forecast_in_words(sweeps.len(), &sweeps[0].2) {
            Some(words) => format!("{words}\n"),
            None => "nothing can be made from any place\n".to_owned(),
        });
    }
    let units = sweeps[0].2.settings.output.units;
    let ring = ring_range(&options.players);
    let (mut players, mut finished, mut posters) = (Vec::new(), Vec::new(), Vec::new());
    let count = sweeps.len();
    if !quiet && !folders.iter().any(|folder| folder.exists()) {
        forecast_in_words(count, &sweeps[0].2)
            .iter()
            .for_each(|words| print_remark(words));
    }
    for (number, ((name, fit, config, texts), folder)) in
        sweeps.into_iter().zip(&folders).enumerate()
    {
        if !quiet {
            print_remark(&format!(
                "player {} of {count}, {name}: {}",
                number + 1,
                folder.display()
            ));
        }
        let (swept, _) = compute(folder, &config, &texts, run_options(Shard::WHOLE), quiet)?;
        let (rows, _) = swept.union()?;
        let mut places = PlaceProbabilities::of_sweep(&config, &rows);
        let bars = ProgressBars::new(quiet);
        find_ring_dependence(&mut places, &config, ring, &bars)?;
        let mut advice = None;
        if let Some(fit) = &fit {
            find_sureness(&mut places, &config, fit, &bars)?;
            advice = Some(PlayerAdvice::of_fit(fit, &config.settings.output, &bars)?);
        }
        let own = advice.as_ref().map(|advice| advice.poster.as_str());
        posters.extend(write_pictures(
            folder,
            (&name, own),
            (&config, &rows),
            &places,
        )?);
        players.push(PlayerSweep {
            name,
            places,
            advice: advice.map(|advice| (advice.page, advice.from)),
        });
        finished.push((config, rows));
    }
    let results: Vec<SweepResults<'_>> = finished
        .iter()
        .zip(&players)
        .map(|((config, rows), player)| {
            SweepResults::new(config, rows).with_chances(player.places.clone())
        })
        .collect();
    let maps = team_maps::draw(&results, &best_players(&players));
    plot_files::write(&options.out, maps.as_slice())?;
    let is_one_sided = finished.iter().any(|(config, _)| {
        let correlation = &config.settings.shooter.dispersion.correlation;
        ReleaseVariable::ALL.into_iter().any(|other| {
            correlation.coefficient(ReleaseVariable::Polar, other) != 0.0
                && other != ReleaseVariable::Polar
        })
    });
    let csv = team_csv(&players, units);
    let file = options.out.join("team.csv");
    atomic_file::write(&file, csv.as_bytes())
        .map_err(|error| Failure::io(file.display(), &error))?;
    let posters_name = (!posters.is_empty()).then(|| "posters.html".to_owned());
    if let Some(name) = &posters_name {
        let file = options.out.join(name);
        atomic_file::write(&file, posters_page(&posters).as_bytes())
            .map_err(|error| Failure::io(file.display(), &error))?;
    }
    let has_several_places = players.iter().any(|player| player.places.len() > 1);
    let sides_differ = is_one_sided && has_several_places;
    let remarks = match sides_differ {
        true => warnings + SIDES_DIFFER,
        false => warnings,
    };
    let others = other_players(&options.out, &folders);
    if !others.is_empty() && !quiet {
        print_remark(&format!(
            "{} also holds sweeps of other players ({}): its page, table and posters are now those of {} alone; name all to have all",
            options.out.display(),
            others.join(", "),
            match &players[..] {
                [one] => one.name.clone(),
                more => format!("these {} players", more.len()),
            }
        ));
    }
    let page = team_page(&players, maps, posters_name, (&remarks, ring), units);
    let page_file = options.out.join("team.html");
    atomic_file::write(&page_file, page.html().as_bytes())
        .map_err(|error| Failure::io(page_file.display(), &error))?;
    print_prose(&team_text(&players, ring, units))?;
    if sides_differ {
        print_prose(SIDES_DIFFER)?;
    }
    if !quiet {
        print_remark(&format!(
            "written: {} (to look at or print); beside it posters.html (a sheet to print for each player), team.csv and team.svg; in each player's folder bank_and_direct.svg and poster.html",
            page_file.display()
        ));
        if let [first, second, ..] = &folders[..] {
            print_remark(&format!(
                "next, where one beats the other: bankshot compare {} --against {}",
                first.display(),
                second.display()
            ));
        }
    }
    Ok(code::DONE)
}

/// Kinds that differ by more than this in P are compared by no draws: the better one is.
const FAR_APART: f64 = 0.1;

/// Finds in how many draws of a player's fit the bank shot is the better one, at each place where
/// one kind is preferred to the other.
fn find_sureness(
    places: &mut [PlaceProbabilities],
    config: &SweepConfig,
    fit: &FitFolder,
    progress: &dyn Progress,
) -> Result<(), Failure> {
    let is_open = |place: &&mut PlaceProbabilities| {
        let is_near = |gain: Difference| gain.value.abs() <= FAR_APART;
        place.preference() != Some(Preference::Either) && place.bank_gain().is_some_and(is_near)
    };
    let open: Vec<&mut PlaceProbabilities> = places.iter_mut().filter(is_open).collect();
    progress.begin("bank or direct, over the draws", open.len() as u64);
    for place in open {
        place.fitted_shots = Some(fit.posterior.shots);
        if let [Some(direct), Some(bank)] = &place.nominals {
            let profile = config.settings.at(place.place.location())?;
            let share = fit_folder::bank_is_better(fit, &profile, [direct, bank])?;
            place.bank_is_better = Some(share);
        }
        progress.advance(1);
    }
    progress.end();
    Ok(())
}

/// Standard error of P under another ring: the differences share their samples.
const RING_ERROR: f64 = 0.002;

/// Finds by how much the bank shot, where it is preferred, is better on the rings that sources
/// give: nobody measured that of the gym. The shots stay as they are.
fn find_ring_dependence(
    places: &mut [PlaceProbabilities],
    config: &SweepConfig,
    (low, high): (f64, f64),
    progress: &dyn Progress,
) -> Result<(), Failure> {
    let is_bank = |place: &&mut PlaceProbabilities| place.preference() == Some(Preference::Bank);
    let places: Vec<&mut PlaceProbabilities> = places.iter_mut().filter(is_bank).collect();
    progress.begin("bank or direct on other rings", places.len() as u64);
    for place in places {
        if let [Some(direct), Some(bank)] = place.nominals {
            let profile = config.settings.at(place.place.location())?;
            let mut least: Option<(f64, f64)> = None;
            for restitution in [low, high] {
                let other = profile.with(|settings| {
                    let set = settings
                        .physics
                        .set_restitution_on(SolidId::Ring, restitution);
                    debug_assert!(set.is_ok(), "sources give restitutions");
                })?;
                let sampler = Sampler::new(&other);
                let [direct, bank] = [&direct, &bank].map(|shot| {
                    let seed = other.search().seed;
                    sampler
                        .estimate(shot, RING_ERROR, seed, &Silent)
                        .probability
                });
                let gain = bank - direct;
                if least.is_none_or(|(least, _)| gain < least) {
                    least = Some((gain, restitution));
                }
            }
            place.least_gain_over_rings = least;
        }
        progress.advance(1);
    }
    progress.end();
    Ok(())
}

/// What a fitted player's own shots say: for the page of the team, and for the poster.
struct PlayerAdvice {
    page: String,
    poster: String,
    /// Where the shots were from.
    from: String,
}

impl PlayerAdvice {
    /// At the first place of the fit.
    fn of_fit(
        fit: &FitFolder,
        output: &OutputSettings,
        progress: &dyn Progress,
    ) -> Result<Self, Failure> {
        let (profile, units) = (&fit.profiles[0], output.units);
        let advice = advise(profile, &fit.posterior, 0, progress)?;
        let (name, location) = (&profile.shooter().name, profile.location());
        let (observed, angle) = (Some(fit.observed[0]), location.angle_rad);
        let from = location.in_words(units);
        Ok(Self {
            page: brief_advice_text(name, &advice, observed, angle, units),
            poster: advice_for_poster(&advice, observed, (&from, angle), units),
            from,
        })
    }
}

/// The restitutions that the ring may have: those that the makes tell, where the folder of the fits
/// or a fit has what `--free hoop_restitution` found, else those that sources give.
fn ring_range(players: &[PathBuf]) -> (f64, f64) {
    let parameter = UnseenParameter::HoopRestitution;
    let (low, high) = parameter.usual_range();
    let told = players.iter().flat_map(|path| {
        let folder = if path.is_dir() {
            path.as_path()
        } else {
            path.parent().unwrap_or(Path::new(""))
        };
        let of_all = [folder.join("free.json"), folder.join("../free.json")];
        let read = |file: &PathBuf| -> Option<serde_json::Value> {
            serde_json::from_str(&std::fs::read_to_string(file).ok()?).ok()
        };
        let mut found: Vec<serde_json::Value> = of_all.iter().filter_map(read).collect();
        found.extend(read(&folder.join("fit.json")).map(|fit| fit["free"].clone()));
        found
    });
    let range = |list: serde_json::Value| {
        let found = list
            .as_array()?
            .iter()
            .find(|of| of["name"] == parameter.name())?;
        let is_decided = found["is_decided"].as_bool()?;
        let ends = (found["low"].as_f64()?, found["high"].as_f64()?);
        is_decided.then_some(ends)
    };
    let found = told.filter_map(range).find(|(low, high)| low < high);
    found.unwrap_or((low, high))
}

/// What all players take, from the first one's sweep.
fn forecast_in_words(players: usize, first: &SweepConfig) -> Option<String> {
    let seconds = forecast_s(first, true)? * players as f64;
    let time = time_in_words(seconds);
    let players = match players {
        1 => "1 player".to_owned(),
        more => format!("{more} players"),
    };
    Some(format!("{players}: about {time} in all"))
}

/// The folders of sweeps in a team's folder that are not those of its players.
fn other_players(out: &Path, folders: &[PathBuf]) -> Vec<String> {
    let entries = std::fs::read_dir(out).into_iter().flatten().flatten();
    let others = entries
        .map(|entry| entry.path())
        .filter(|path| path.join("configuration.json").is_file() && !folders.contains(path));
    let mut names: Vec<String> = others
        .filter_map(|path| Some(path.file_name()?.to_string_lossy().into_owned()))
        .collect();
    names.sort();
    names
}

/// Writes a player's map and poster; returns the poster.
fn write_pictures(
    folder: &Path,
    (name, own): (&str, Option<&str>),
    (config, rows): (&SweepConfig, &BTreeMap<u64, ResultRow>),
    places: &[PlaceProbabilities],
) -> Result<Option<PlayerPoster>, Failure> {
    let results = SweepResults::new(config, rows).with_chances(places.to_vec());
    let mut plots = Vec::new();
    plots.extend(sweep_bank_direct_map::draw(&results));
    let poster = player_poster::draw(&results, own);
    if let Some(poster) = &poster {
        let file = folder.join("poster.html");
        atomic_file::write(&file, poster_page(name, poster).as_bytes())
            .map_err(|error| Failure::io(file.display(), &error))?;
        plots.push(poster.plot.clone());
    }
    plot_files::write(folder, &plots)?;
    Ok(poster)
}
