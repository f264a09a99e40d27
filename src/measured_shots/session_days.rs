//! Sessions by date: the days that a column names, in the order of time.

/// The order of day and month in dates that do not say it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DateOrder {
    /// 14/10/2025.
    DayFirst,
    /// 10/14/2025.
    MonthFirst,
}

/// A moment: year, month, day, and the second of the day.
type Moment = (i64, u32, u32, f64);

/// How a column writes its moments.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Form {
    /// 2025-10-14, 2025/10/14, 20251014, 14 Oct 2025, Oct 14, 2025.
    Clear,
    /// Numbers with day and month in either order.
    Numbers(DateOrder),
    /// Seconds since 1970, and how many of the cell's units a second has.
    Unix(f64),
    /// Days since 1899-12-30.
    Excel,
}

/// The days of a column, as 2025-10-14, and the moment of each row; or why it has none.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Days {
    /// Each row's moment, `None` for an empty cell; and whether the cells have times of day.
    Moments(Vec<Option<Moment>>, bool),
    /// The cells are no dates.
    NoDates,
    /// Dates whose order of day and month nothing says; the first of them.
    Ambiguous(String),
}

const MONTHS: [&str; 12] = [
    "jan", "feb", "mar", "apr", "may", "jun", "jul", "aug", "sep", "oct", "nov", "dec",
];
/// Months that other languages write in other letters.
const OTHER_MONTHS: [(&str, u32); 8] = [
    ("mrz", 3),
    ("mär", 3),
    ("mai", 5),
    ("okt", 10),
    ("dez", 12),
    ("fév", 2),
    ("avr", 4),
    ("aoû", 8),
];

/// A session has at least so many shots on average.
pub(super) const SHOTS_OF_SESSION: usize = 3;

/// Whether all cells are dates.
pub(super) fn are_dates(cells: &[&str]) -> bool {
    matches!(days(cells, Some(DateOrder::DayFirst)), Days::Moments(..))
}

/// Whether cells can tell sessions apart: several values, or days, with enough rows for each.
pub(super) fn can_tell_sessions(cells: &[&str]) -> bool {
    let mut names: Vec<String> = match days(cells, Some(DateOrder::DayFirst)) {
        Days::Moments(moments, _) => moments.iter().flatten().map(day_in_words).collect(),
        _ => cells.iter().map(|cell| (*cell).to_owned()).collect(),
    };
    names.sort();
    names.dedup();
    (2..=cells.len() / SHOTS_OF_SESSION).contains(&names.len())
}

/// The day as text.
pub(super) fn day_in_words(moment: &Moment) -> String {
    format!("{:04}-{:02}-{:02}", moment.0, moment.1, moment.2)
}

/// The moments of the cells of a column. All must be dates.
pub(super) fn days(cells: &[&str], order: Option<DateOrder>) -> Days {
    let filled: Vec<&str> = cells
        .iter()
        .copied()
        .filter(|cell| !cell.is_empty())
        .collect();
    if filled.is_empty() {
        return Days::NoDates;
    }
    let all = |form: Form| -> Option<Vec<Moment>> {
        filled.iter().map(|cell| moment(cell, form)).collect()
    };
    let mut form = [Form::Clear, Form::Unix(1.0), Form::Unix(1e3), Form::Excel]
        .into_iter()
        .find(|form| all(*form).is_some());
    if form.is_none() {
        let orders = [DateOrder::DayFirst, DateOrder::MonthFirst];
        let possible: Vec<DateOrder> = orders
            .into_iter()
            .filter(|order| all(Form::Numbers(*order)).is_some())
            .collect();
        // Points stand between day, month and year where the day comes first.
        let has_points = filled[0]
            .split_whitespace()
            .next()
            .is_some_and(|day| day.contains('.'));
        let own = match possible[..] {
            [] => return Days::NoDates,
            [one] => one,
            _ if has_points => DateOrder::DayFirst,
            _ => match order {
                Some(order) => order,
                None => return Days::Ambiguous(filled[0].to_owned()),
            },
        };
        form = Some(Form::Numbers(own));
    }
    let Some(form) = form else {
        return Days::NoDates;
    };
    let moments: Vec<Option<Moment>> = cells.iter().map(|cell| moment(cell, form)).collect();
    let has_times = moments.iter().flatten().any(|moment| moment.3 > 0.0);
    Days::Moments(moments, has_times)
}

fn moment(cell: &str, form: Form) -> Option<Moment> {
    match form {
        Form::Unix(per_second) => {
            let seconds = cell.parse::<f64>().ok()? / per_second;
            // From 2001 to 2099.
            (9.78e8..4.1e9)
                .contains(&seconds)
                .then(|| of_days(seconds / 86_400.0))
        }
        Form::Excel => {
            let days = cell.parse::<f64>().ok()?;
            // From 2000 to 2099; a count of shots or sessions is less.
            (36_526.0..73_050.0)
                .contains(&days)
                .then(|| of_days(days - 25_569.0))
        }
        Form::Clear | Form::Numbers(_) => {
            let (day, second) = day_and_time(cell)?;
            let (year, month, day) = date(day, form)?;
            let is_day = (1..=12).contains(&month) && (1..=31).contains(&day);
            is_day.then_some((year, month, day, second))
        }
    }
}

/// The date of a cell and the second of the day.
fn day_and_time(cell: &str) -> Option<(&str, f64)> {
    let cell = cell.trim();
    // Where the time begins: two digits and a colon.
    let Some(colon) = cell.find(':') else {
        return Some((cell, 0.0));
    };
    let digits = cell[..colon]
        .bytes()
        .rev()
        .take_while(u8::is_ascii_digit)
        .count();
    let start = colon - digits;
    let day = cell[..start].trim_end_matches(|c: char| c.is_whitespace() || c == 'T' || c == ',');
    let mut parts = cell[start..].split(':');
    let mut hours: f64 = parts.next()?.parse().ok()?;
    let number = |text: &str| {
        let end = text
            .find(|c: char| !c.is_ascii_digit() && c != '.')
            .unwrap_or(text.len());
        text[..end].parse::<f64>().ok()
    };
    let minutes = number(parts.next()?)?;
    let seconds = parts.next().and_then(number).unwrap_or(0.0);
    let lower = cell.to_ascii_lowercase();
    if lower.ends_with("pm") && hours < 12.0 {
        hours += 12.0;
    } else if lower.ends_with("am") && hours == 12.0 {
        hours = 0.0;
    }
    Some((day, 3600.0 * hours + 60.0 * minutes + seconds))
}

fn date(day: &str, form: Form) -> Option<(i64, u32, u32)> {
    let parts: Vec<&str> = day
        .split(|c: char| matches!(c, '-' | '/' | '.' | ',') || c.is_whitespace())
        .filter(|part| !part.is_empty())
        .collect();
    let numbers: Vec<Option<u32>> = parts.iter().map(|part| part.parse().ok()).collect();
    match (form, &numbers[..]) {
        (Form::Clear, [Some(compact)]) if parts[0].len() == 8 => {
            let (year, month, day) = (compact / 10_000, compact / 100 % 100, compact % 100);
            (1900..2100)
                .contains(&year)
                .then_some((i64::from(year), month, day))
        }
        (Form::Clear, [Some(year), Some(month), Some(day)]) if parts[0].len() == 4 => {
            Some((i64::from(*year), *month, *day))
        }
        (Form::Numbers(order), [Some(first), Some(second), Some(year)]) => {
            let (day, month) = match order {
                DateOrder::DayFirst => (*first, *second),
                DateOrder::MonthFirst => (*second, *first),
            };
            Some((full_year(*year, parts[2])?, month, day))
        }
        // A month has its name; a weekday may stand before it, a year may be left out.
        (Form::Clear, _) => {
            let month = parts.iter().find_map(|part| month_of(part))?;
            let mut rest = numbers
                .iter()
                .zip(&parts)
                .filter_map(|(n, part)| Some(((*n)?, part)));
            let (first, first_text) = rest.next()?;
            match rest.next() {
                Some((year, text)) if first_text.len() <= 2 => {
                    Some((full_year(year, text)?, month, first))
                }
                Some((day, _)) => Some((i64::from(first), month, day)),
                None if parts.len() <= 2 && first <= 31 => Some((0, month, first)),
                None => None,
            }
        }
        _ => None,
    }
}

fn full_year(year: u32, text: &str) -> Option<i64> {
    match text.len() {
        2 => Some(2000 + i64::from(year)),
        4 => Some(i64::from(year)),
        _ => None,
    }
}

fn month_of(part: &str) -> Option<u32> {
    let lower = part.to_lowercase();
    let start: String = lower.chars().take(3).collect();
    let english = MONTHS.iter().position(|month| *month == start);
    english.map(|index| index as u32 + 1).or_else(|| {
        let other = OTHER_MONTHS.iter().find(|(month, _)| *month == start);
        other.map(|(_, number)| *number)
    })
}

/// The moment that is so many days after 1970-01-01 (Hinnant's algorithm for the proleptic
/// Gregorian calendar).
fn of_days(days: f64) -> Moment {
    let whole = days.floor();
    let shifted = whole as i64 + 719_468;
    let era = shifted.div_euclid(146_097);
    let of_era = shifted.rem_euclid(146_097);
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted_month = (5 * of_year + 2) / 153;
    let day = (of_year - (153 * shifted_month + 2) / 5 + 1) as u32;
    let month = if shifted_month < 10 {
        shifted_month + 3
    } else {
        shifted_month - 9
    } as u32;
    let year = year_of_era + 400 * era + i64::from(month <= 2);
    (year, month, day, 86_400.0 * (days - whole))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn day(cells: &[&str], order: Option<DateOrder>) -> String {
        match days(cells, order) {
            Days::Moments(moments, _) => day_in_words(&moments[0].unwrap()),
            other => format!("{other:?}"),
        }
    }

    /// Authority: the calendar; `date -d @1760400000`, a spreadsheet's 45944.
    #[test]
    fn val_dates_in_every_common_form() {
        for cells in [
            &["2025-10-14"][..],
            &["2025/10/14 17:05"],
            &["2025-10-14T17:05:30Z"],
            &["20251014"],
            &["10/14/2025"],
            &["10/14/25 5:05:10 PM"],
            &["14/10/2025"],
            &["14.10.2025"],
            &["14.10.25 17:05"],
            &["Oct 14, 2025"],
            &["October 14 2025"],
            &["14 Oct 2025"],
            &["14-Oct-2025 17:05"],
            &["14. Okt. 2025"],
            &["Tue, Oct 14, 2025"],
            &["1760400000"],
            &["1760400000000"],
            &["45944"],
            &["45944.71"],
        ] {
            assert_eq!(day(cells, None), "2025-10-14", "{cells:?}");
        }
        assert_eq!(day(&["03.04.2025"], None), "2025-04-03");
        assert_eq!(day(&["03/04/2025", "10/14/2025"], None), "2025-03-04");
        assert_eq!(
            day(&["03/04/2025"], Some(DateOrder::DayFirst)),
            "2025-04-03"
        );
        assert_eq!(
            day(&["03/04/2025"], Some(DateOrder::MonthFirst)),
            "2025-03-04"
        );
        assert!(matches!(days(&["03/04/2025"], None), Days::Ambiguous(_)));
        for cells in [
            &["September"][..],
            &["1"],
            &["2"],
            &["before"],
            &["12"],
            &["2025"],
            &["A 3"],
        ] {
            assert_eq!(days(cells, None), Days::NoDates, "{cells:?}");
        }
    }
}
