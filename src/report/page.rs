//! The page as one HTML file.

use super::html_table::HtmlTable;
use super::page_data::Scene;
use super::shot_in_words::{ReportShot, most_probable};
use crate::dynamics::StateError;
use crate::escape::{html, json_in_script};
use crate::plots::svg::Plot;
use crate::plots::svg::shortened;
use std::fmt::Write;

const HTML: &str = include_str!("../../assets/report/page.html");
const CSS: &str = include_str!("../../assets/report/page.css");
/// Built from `studio/src/report.ts`.
const JS: &str = include_str!("../../studio/dist/report.js");
/// Longest name in a title, in characters.
const LONGEST_NAME: usize = 120;

/// The content of a page.
#[derive(Clone, Debug)]
pub struct Page {
    /// Title.
    pub title: String,
    /// The answer in a sentence or two.
    pub answer: String,
    /// The shots, at least one.
    pub shots: Vec<ReportShot>,
    /// The place that is shown first.
    pub first_place: usize,
    /// Where the shots are taken.
    pub scene: Scene,
    /// Another shooter's shots from one place, which the page shows in turn with the own ones.
    pub other_shooter: Option<OtherShooter>,
    /// Tables.
    pub tables: Vec<HtmlTable>,
    /// Plots.
    pub plots: Vec<Plot>,
    /// Program and input that made the page.
    pub footer: String,
}

/// The shots of another shooter on a page of two.
#[derive(Clone, Debug)]
pub struct OtherShooter {
    scene: Scene,
    shots: Vec<ReportShot>,
    /// The names of both.
    names: [String; 2],
}

impl OtherShooter {
    /// Adds the shots to the data of a page. Shooters take the part of places.
    fn add_to(&self, data: &mut serde_json::Value) -> Result<(), StateError> {
        let mut others = self.scene.page_data(&self.shots, 0)?;
        let others_far_x_m = others["far_x_m"].clone();
        let (Some(own), Some(others)) =
            (data["shots"].as_array_mut(), others["shots"].as_array_mut())
        else {
            return Ok(());
        };
        let own_shots = own.len();
        own.append(others);
        for (index, shot) in own.iter_mut().enumerate() {
            let shooter = usize::from(index >= own_shots);
            shot["place"] = shooter.into();
            shot["where"] = self.names[shooter].clone().into();
        }
        let far_x_m = [&data["far_x_m"], &others_far_x_m].map(|x| x.as_f64().unwrap_or(0.0));
        data["far_x_m"] = far_x_m[0].max(far_x_m[1]).into();
        data["first_place"] = 0.into();
        data["places_are"] = "Shooter".into();
        Ok(())
    }
}

impl Page {
    /// Adds the answer, the tables and the plots of another page, and a plot of the difference if
    /// there is one.
    pub fn add_comparison(&mut self, other: Self, difference: Option<Plot>) {
        let of_one_place = difference.is_none();
        let compared = if of_one_place {
            self.best_shots_compared(&other)
        } else {
            None
        };
        self.answer = format!(
            "{4}{0}: {1}\n{2}: {3}",
            self.title,
            self.answer,
            other.title,
            other.answer,
            compared.unwrap_or_default()
        );
        if of_one_place {
            self.answer += "\nBoth profiles are taken as exact, and \u{b1} is numerical: what a few shots do not tell of a player is not in these numbers.";
        } else {
            self.answer += &format!("\nThe shots that move are those of {}.", self.title);
        }
        if let Some(plot) = &difference {
            self.answer = format!("{}\n{}", self.answer, plot.caption);
        }
        for table in &mut self.tables {
            table.name(&self.title);
        }
        let own_shots = self.shots.len();
        self.tables
            .extend(other.tables.into_iter().map(|mut table| {
                table.name(&other.title);
                for (shot, _) in &mut table.rows {
                    // Of two sweeps the page shows the paths of the first alone.
                    *shot = shot.filter(|_| of_one_place).map(|shot| own_shots + shot);
                }
                table
            }));
        if of_one_place {
            self.other_shooter = Some(OtherShooter {
                scene: other.scene,
                shots: other.shots,
                names: [self.title.clone(), other.title.clone()],
            });
        }
        for plot in &mut self.plots {
            plot.caption = format!("{}: {}", self.title, plot.caption);
        }
        // Each plot beside its counterpart: what is compared stands together.
        for mut plot in other.plots {
            plot.caption = format!("{}: {}", other.title, plot.caption);
            let counterpart = self.plots.iter().position(|own| own.name == plot.name);
            let place = counterpart.map_or(self.plots.len(), |index| index + 1);
            plot.name.push_str("_against");
            self.plots.insert(place, plot);
        }
        if let Some(plot) = difference {
            self.plots.insert(0, plot);
        }
        self.title = format!("{} against {}", self.title, other.title);
        self.footer = format!("{} {}", self.footer, other.footer);
    }

    /// Whose best shot makes more, of two pages of one place each.
    fn best_shots_compared(&self, other: &Self) -> Option<String> {
        let best = |page: &Self| most_probable(&page.shots).map(|shot| shot.shot.probability);
        let (own, others) = (best(self)?, best(other)?);
        let points = 100.0 * (own - others);
        Some(if points.abs() < 1.0 {
            format!(
                "{} and {} are level: {:.1} and {:.1} of 100 go in with their best shots.\n",
                self.title,
                other.title,
                100.0 * own,
                100.0 * others
            )
        } else {
            let (more, less) = if points > 0.0 {
                (&self.title, &other.title)
            } else {
                (&other.title, &self.title)
            };
            format!(
                "{:.1} more of 100 go in for {more} than for {less}, each with the best shot.\n",
                points.abs()
            )
        })
    }

    /// The page as one HTML file.
    ///
    /// # Errors
    /// A shot has a value that is not finite.
    pub fn html(&self) -> Result<String, StateError> {
        let mut body = String::new();
        for (i, table) in self.tables.iter().enumerate() {
            body.push_str(&table.html(i));
        }
        for plot in &self.plots {
            body.push_str(&figure_html(plot));
        }
        let mut data = self.scene.page_data(&self.shots, self.first_place)?;
        if let Some(other) = &self.other_shooter {
            other.add_to(&mut data)?;
        }
        let data = json_in_script(&data.to_string());
        let answer: Vec<String> = self.answer.lines().map(html).collect();
        let parts = [
            ("title", html(&shortened(&self.title, LONGEST_NAME))),
            ("css", CSS.to_owned()),
            ("answer", answer.join("\n")),
            ("body", body),
            ("footer", html(&self.footer)),
            ("data", data),
            ("js", JS.to_owned()),
        ];
        Ok(fill_template(HTML, &parts))
    }
}

fn figure_html(plot: &Plot) -> String {
    // All drawings number their clips from 1, and ids must differ within a page.
    let name = &plot.name;
    let svg = plot
        .svg
        .replace("id=\"clip", &format!("id=\"{name}-clip"))
        .replace("url(#clip", &format!("url(#{name}-clip"));
    let caption = html(&plot.caption);
    let mut html = String::new();
    // Writing to a String never fails.
    let _ = write!(
        html,
        "<figure class=\"wide\" style=\"--aspect: {:.3}\">\n{svg}<figcaption>{caption}</figcaption>\n\
         </figure>\n",
        plot.svg.aspect
    );
    html
}

/// Replaces each `{{name}}` of a template by its part. One pass over the template: braces inside a
/// part stay.
fn fill_template(template: &str, parts: &[(&str, String)]) -> String {
    let mut page = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        page.push_str(before);
        let Some((name, after)) = after.split_once("}}") else {
            break;
        };
        if let Some((_, text)) = parts.iter().find(|(part, _)| *part == name) {
            page.push_str(text);
        }
        rest = after;
    }
    page.push_str(rest);
    page
}
