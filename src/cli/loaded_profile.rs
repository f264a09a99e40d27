//! A profile with its text, which flags change together.

use super::config_files::{other_physics_warning, physics_text, read_text, warnings_of_fit};
use super::failure::Failure;
use super::terminal::{is_quiet, print_remark};
use super::value_parsers::{PhysicsArg, UnitsArg};
use crate::config::{is_physics_alone, parse_physics, parse_profile};
use crate::shooter::{NominalVariable, Profile, implausible_values, nominal_values_not_fixed};
use crate::sweep::sweep_toml::is_sweep;
use std::path::{Path, PathBuf};
use toml_edit::{DocumentMut, Item, TableLike, Value, table};

/// A profile with its text. A change of the text keeps what it does not touch, also comments.
pub(crate) struct LoadedProfile {
    pub(crate) profile: Profile,
    document: DocumentMut,
    path: PathBuf,
}

impl LoadedProfile {
    /// The file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Reads and checks a profile, without a warning.
    pub(crate) fn read(path: &Path, physics: &PhysicsArg) -> Result<Self, Failure> {
        // The folder of a fit or of a run holds its profile.
        let in_folder = path.join("profile.toml");
        let path = if in_folder.is_file() {
            &in_folder
        } else {
            path
        };
        let text = read_profile_text(path)?;
        // The profile itself must be valid, with its own physics.
        let profile = parse_profile(&text, &path.display().to_string())?;
        let loaded = Self {
            document: text.parse().map_err(Failure::bug)?,
            profile,
            path: path.to_owned(),
        };
        match &physics.physics {
            Some(name) => loaded.with_physics(name),
            None => Ok(loaded),
        }
    }

    /// Reads a profile, with warnings of implausible values and of what another physics changes.
    /// `fixed` are nominal values that the command itself fixes.
    pub(crate) fn read_and_warn(
        path: &Path,
        physics: &PhysicsArg,
        fixed: &[NominalVariable],
    ) -> Result<Self, Failure> {
        let own = Self::read(path, &PhysicsArg::default())?;
        if is_quiet() {
            return Self::read(path, physics);
        }
        warn(&own.path, &own.profile, fixed)?;
        let Some(name) = &physics.physics else {
            return Ok(own);
        };
        let before = own.profile.clone();
        let loaded = own.with_physics(name)?;
        if let Some(warning) = other_physics_warning(&before, &loaded.profile, name) {
            print_remark(&warning);
        }
        Ok(loaded)
    }

    /// The profile under another physics.
    fn with_physics(self, name: &str) -> Result<Self, Failure> {
        let text = physics_text(name)?;
        // By itself first, so that a message names the file and its own line.
        parse_physics(&text, name)?;
        let other: DocumentMut = text.parse().map_err(Failure::bug)?;
        self.edited(&format!("--physics '{name}'"), |document| {
            document.remove("physics");
            document.insert("physics", other["physics"].clone());
            Ok(())
        })
    }

    /// The profile with a changed text, which says by which flags.
    pub(crate) fn edited(
        mut self,
        flags: &str,
        edit: impl FnOnce(&mut DocumentMut) -> Result<(), Failure>,
    ) -> Result<Self, Failure> {
        edit(&mut self.document)?;
        let text = format!("# With {flags}\n{}", self.document);
        self.profile = parse_profile(&text, &format!("{} with {flags}", self.path.display()))?;
        self.document = text.parse().map_err(Failure::bug)?;
        Ok(self)
    }

    /// The profile with the units that a flag asks for. They belong to the answer, not to the
    /// profile's text.
    pub(crate) fn in_units(mut self, units: Option<UnitsArg>) -> Result<Self, Failure> {
        if let Some(units) = units {
            let with = self
                .profile
                .with(|settings| settings.output.units = units.into());
            self.profile = with?;
        }
        Ok(self)
    }

    /// The text.
    pub(crate) fn text(&self) -> String {
        self.document.to_string()
    }
}

/// Reads and checks a profile, with its warnings.
pub(crate) fn load_profile(path: &Path, physics: &PhysicsArg) -> Result<Profile, Failure> {
    Ok(LoadedProfile::read_and_warn(path, physics, &[])?.profile)
}

/// A table of a profile, made where there is none.
pub(crate) fn table_mut<'a>(document: &'a mut DocumentMut, name: &str) -> &'a mut dyn TableLike {
    let item: &mut Item = document.entry(name).or_insert_with(table);
    item.as_table_like_mut()
        .expect("a valid profile has a table of this name")
}

/// Puts a value into a table; the comment behind an older one stays.
pub(crate) fn set(table: &mut dyn TableLike, key: &str, value: impl Into<Value>) {
    let mut value: Value = value.into();
    if let Some(old) = table.get(key).and_then(Item::as_value) {
        *value.decor_mut() = old.decor().clone();
    }
    table.insert(key, Item::Value(value));
}

/// The text of a profile. Says what another file is.
fn read_profile_text(path: &Path) -> Result<String, Failure> {
    let shown = path.display();
    let is_table = |end: &std::ffi::OsStr| end == "csv" || end == "parquet";
    if path.extension().is_some_and(is_table) {
        return Err(Failure::usage(format!(
            "{shown}: this is a table, not a profile: `bankshot fit {shown}` makes a profile from measured shots"
        )));
    }
    let text = read_text(path)?;
    if is_sweep(&text) {
        return Err(Failure::usage(format!(
            "{shown}: this is a sweep, not a profile: use `bankshot sweep`"
        )));
    }
    if is_physics_alone(&text) {
        return Err(Failure::usage(format!(
            "{shown}: this is a physics, not a profile: give a profile, and the physics as --physics {shown}"
        )));
    }
    Ok(text)
}

fn warn(path: &Path, profile: &Profile, fixed: &[NominalVariable]) -> Result<(), Failure> {
    let origin = path.display();
    let implausible = implausible_values(profile).into_iter();
    let implausible = implausible.map(|value| value.to_string());
    for words in implausible.chain(nominal_values_not_fixed(profile, fixed)) {
        print_remark(&format!("warning: {words}"));
    }
    let is_first_place = path.file_name().is_some_and(|name| name == "profile.toml");
    if is_first_place && path.with_file_name("profile_place_2.toml").is_file() {
        print_remark(&format!(
            "{origin}: is that of the first place of its fit; the others are beside it, profile_place_2.toml and so on"
        ));
    }
    for words in warnings_of_fit(path)? {
        print_remark(&format!("warning: {origin}: its fit warned: {words}"));
    }
    Ok(())
}
