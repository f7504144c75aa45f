//! The settings by name, for those who read them: scene files and the flags of the command.

use super::method::{ContactEvents, Method};
use super::record::Settings;
use crate::base::input::InputError;

/// A field of [`Settings`] as it is read from a text.
#[derive(Debug, Clone, Copy)]
pub struct SettingsOption {
    /// Its name in the table `[solver]` of scene files, and in [`Settings`].
    pub key: &'static str,
    /// Meaning of the option, in words.
    pub meaning: &'static str,
    /// Its unit: "1" for numbers without one, empty for values that are not numbers.
    pub unit: &'static str,
    /// Its default: the value as in a scene file, or words.
    pub default: &'static str,
    /// Placeholder of its value in the help of the command.
    pub value_name: &'static str,
    /// Reader of its value into [`Settings`].
    pub value: SettingsValue,
}

/// Type of the value of an option, with the function that sets it in [`Settings`].
#[derive(Debug, Clone, Copy)]
pub enum SettingsValue {
    /// A number.
    Number(fn(&mut Settings, f64)),
    /// A whole number, 0 or above.
    Count(fn(&mut Settings, usize)),
    /// True or false.
    Flag(fn(&mut Settings, bool)),
    /// One of some words: all of them, and the function, which refuses others.
    Word(fn() -> Vec<&'static str>, fn(&mut Settings, &str) -> Result<(), InputError>),
}

impl SettingsOption {
    /// Name of its flag of the command.
    pub fn flag(&self) -> String {
        self.key.replace('_', "-")
    }

    /// All options, one for each field of [`Settings`].
    pub const ALL: [Self; 11] = [
        Self {
            key: "method",
            meaning: "integration method: see \"pliant methods\"",
            unit: "",
            default: "auto",
            value_name: "METHOD",
            value: SettingsValue::Word(
                || Method::ALL.map(Method::name).into(),
                |settings, word| word.parse().map(|method| settings.method = method),
            ),
        },
        Self {
            key: "rtol",
            meaning: "relative tolerance",
            unit: "1",
            default: "1e-5",
            value_name: "RTOL",
            value: SettingsValue::Number(|settings, rtol| settings.rtol = rtol),
        },
        Self {
            key: "atol_position",
            meaning: "absolute tolerance of displacements",
            unit: "m",
            default: "`rtol` times a hundredth of the size of the body",
            value_name: "METRES",
            value: SettingsValue::Number(|settings, atol| settings.atol_position = Some(atol)),
        },
        Self {
            key: "atol_velocity",
            meaning: "absolute tolerance of velocities",
            unit: "m/s",
            default: "`rtol` times a hundredth of the speed of waves; with friction at most 1/400 of `sticking_speed`",
            value_name: "METRES/SECOND",
            value: SettingsValue::Number(|settings, atol| settings.atol_velocity = Some(atol)),
        },
        Self {
            key: "alpha",
            meaning: "rate at which errors of constraints decay",
            unit: "1/s",
            default: "1e3",
            value_name: "1/SECONDS",
            value: SettingsValue::Number(|settings, alpha| settings.alpha = alpha),
        },
        Self {
            key: "max_order",
            meaning: "order of the method, the highest one of a multistep method",
            unit: "",
            default: "that of the method: see \"pliant methods\"",
            value_name: "ORDER",
            value: SettingsValue::Count(|settings, order| {
                settings.max_order = Some(u32::try_from(order).unwrap_or(u32::MAX));
            }),
        },
        Self {
            key: "stability_limit_detection",
            meaning: "whether BDF lowers its order where stability bounds its steps",
            unit: "",
            default: "false",
            value_name: "true|false",
            value: SettingsValue::Flag(|settings, flag| settings.stability_limit_detection = flag),
        },
        Self {
            key: "contact_events",
            meaning: "how contact events are met: auto, step-over or locate",
            unit: "",
            default: "auto",
            value_name: "WAY",
            value: SettingsValue::Word(
                || ContactEvents::ALL.map(ContactEvents::name).into(),
                |settings, word| word.parse().map(|way| settings.contact_events = way),
            ),
        },
        Self {
            key: "max_step",
            meaning: "longest step",
            unit: "s",
            default: "none",
            value_name: "SECONDS",
            value: SettingsValue::Number(|settings, step| settings.max_step = Some(step)),
        },
        Self {
            key: "max_steps",
            meaning: "steps that a phase may take",
            unit: "",
            default: "10000000",
            value_name: "STEPS",
            value: SettingsValue::Count(|settings, steps| settings.max_steps = steps),
        },
        Self {
            key: "max_time",
            meaning: "wall-clock time that a run may take, each of them where there are several",
            unit: "s",
            default: "none",
            value_name: "SECONDS",
            value: SettingsValue::Number(|settings, time| settings.max_time = Some(time)),
        },
    ];
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each option sets its own field, and each field has an option: a new field of [`Settings`] has to be
    /// named here.
    #[test]
    fn every_field_has_an_option() {
        let default = Settings::default();
        let mut all = default.clone();
        for option in SettingsOption::ALL {
            let mut one = default.clone();
            for settings in [&mut one, &mut all] {
                match option.value {
                    SettingsValue::Number(set) => set(settings, 0.123),
                    SettingsValue::Count(set) => set(settings, 3),
                    SettingsValue::Flag(set) => set(settings, true),
                    SettingsValue::Word(words, set) => {
                        set(settings, words().last().unwrap()).unwrap()
                    }
                }
            }
            assert_ne!(one, default, "{}", option.key);
        }
        let Settings {
            method,
            rtol,
            atol_position,
            atol_velocity,
            alpha,
            max_order,
            stability_limit_detection,
            contact_events,
            max_step,
            max_steps,
            max_time,
        } = all;
        assert_eq!((method, contact_events), (Method::CentralDifference, ContactEvents::Locate));
        assert_eq!([rtol, alpha], [0.123; 2]);
        assert_eq!([atol_position, atol_velocity, max_step, max_time], [Some(0.123); 4]);
        assert_eq!((max_order, max_steps, stability_limit_detection), (Some(3), 3, true));
    }

    /// The defaults that options state are those in force.
    #[test]
    fn defaults_are_told() {
        let mut told = 0;
        for option in SettingsOption::ALL {
            let mut settings = Settings::default();
            match (option.value, option.default.parse::<f64>()) {
                (SettingsValue::Number(set), Ok(number)) => set(&mut settings, number),
                (SettingsValue::Count(set), Ok(count)) => set(&mut settings, count as usize),
                (SettingsValue::Flag(set), _) => set(&mut settings, option.default == "true"),
                (SettingsValue::Word(_, set), _) => set(&mut settings, option.default).unwrap(),
                _ => continue,
            }
            assert_eq!(settings, Settings::default(), "{}", option.key);
            told += 1;
        }
        assert_eq!(told, 6);
    }

    #[test]
    fn words_that_mean_nothing_are_refused() {
        for option in SettingsOption::ALL {
            if let SettingsValue::Word(words, set) = option.value {
                let error = set(&mut Settings::default(), "nothing").unwrap_err().to_string();
                assert!(error.contains(option.key), "{error}");
                assert!(words().iter().all(|word| error.contains(word)), "{error}");
            }
        }
    }
}
