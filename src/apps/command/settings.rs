//! Flags that override `[solver]`, made from the table of all settings.

use clap::{Arg, ArgMatches, Args, Command, FromArgMatches, value_parser};
use pliant::{InputError, Scene, Settings, SettingsOption, SettingsValue as Value};

use super::failure::Failure;

/// The flags that were given.
pub struct SettingsArguments(ArgMatches);

impl SettingsArguments {
    /// Overrides the values of `settings`.
    pub fn apply(&self, settings: &mut Settings) -> Result<(), InputError> {
        for SettingsOption { key, value, .. } in SettingsOption::ALL {
            match value {
                Value::Number(set) => self.get(key).map(|&number| set(settings, number)),
                Value::Count(set) => self.get(key).map(|&count| set(settings, count)),
                Value::Flag(set) => self.get(key).map(|&flag| set(settings, flag)),
                Value::Word(_, set) => {
                    self.get::<String>(key).map(|word| set(settings, word)).transpose()?
                }
            };
        }
        settings.validate()
    }

    /// Whether the flag of an option was given.
    pub fn has(&self, key: &str) -> bool {
        self.0.contains_id(key)
    }

    fn get<T: Clone + Send + Sync + 'static>(&self, key: &str) -> Option<&T> {
        self.0.get_one(key)
    }
}

impl Args for SettingsArguments {
    fn augment_args(command: Command) -> Command {
        command.args(SettingsOption::ALL.iter().map(argument))
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for SettingsArguments {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        Ok(Self(matches.clone()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        self.0 = matches.clone();
        Ok(())
    }
}

/// The scene, ended at the time of the flag `--until` (s) if that was given.
pub fn ended(scene: Scene, until: Option<f64>) -> Result<Scene, Failure> {
    match until {
        Some(time) if time > scene.end() => Err(Failure::bad_input(format!(
            "--until = {time} s cannot be used: the scene ends at {} s; let its last phase last longer (until in \
             the scene file)",
            scene.end()
        ))),
        Some(time) => Ok(scene.ended_at(time)),
        None => Ok(scene),
    }
}

fn argument(option: &SettingsOption) -> Arg {
    let SettingsOption { key, meaning, unit, value_name, value, .. } = *option;
    let mut help = match unit {
        "" | "1" => meaning.to_owned(),
        unit => format!("{meaning} ({unit})"),
    };
    help[..1].make_ascii_uppercase();
    let argument = Arg::new(key).long(option.flag()).value_name(value_name).help(help);
    match value {
        Value::Number(_) => argument.value_parser(value_parser!(f64)),
        Value::Count(_) => argument.value_parser(value_parser!(usize)),
        Value::Flag(_) => argument
            .value_parser(value_parser!(bool))
            .num_args(0..=1)
            .require_equals(true)
            .default_missing_value("true"),
        Value::Word(_, set) => argument.value_parser(move |word: &str| {
            set(&mut Settings::default(), word).map(|()| word.to_owned())
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every option has its flag, which sets what its key in a scene file sets.
    #[test]
    fn every_setting_has_a_flag() {
        let command = SettingsArguments::augment_args(Command::new("run"));
        for option in SettingsOption::ALL {
            let flag = format!("--{}", option.flag());
            let mut expected = Settings::default();
            let given = match option.value {
                Value::Number(set) => {
                    set(&mut expected, 0.25);
                    format!("{flag}=0.25")
                }
                Value::Count(set) => {
                    set(&mut expected, 3);
                    format!("{flag}=3")
                }
                Value::Flag(set) => {
                    set(&mut expected, true);
                    flag
                }
                Value::Word(words, set) => {
                    let word = words()[1];
                    set(&mut expected, word).unwrap();
                    format!("{flag}={word}")
                }
            };
            let matches = command.clone().try_get_matches_from(["run", &given]).unwrap();
            let arguments = SettingsArguments::from_arg_matches(&matches).unwrap();
            let mut settings = Settings::default();
            arguments.apply(&mut settings).unwrap();
            assert_eq!(settings, expected, "{given}");
            assert_ne!(settings, Settings::default(), "{given}");
        }
    }
}
