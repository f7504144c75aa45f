//! The settings by name, for those who read them: scene files and the flags of the command.

use super::method::{ContactEvents, Method};
use super::record::Settings;
use crate::input::InputError;

/// A field of [`Settings`] as it is read from a text.
#[derive(Debug, Clone, Copy)]
pub struct SettingsOption {
    /// Name of the flag of the command.
    pub name: &'static str,
    /// What it is, with its unit.
    pub meaning: &'static str,
    /// What stands for its value in the help of the command.
    pub value_name: &'static str,
    /// How its value is read and put into [`Settings`].
    pub value: SettingsValue,
}

/// What kind of value an option has, with the function that puts it into [`Settings`].
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
    /// Its name in the table `[solver]` of scene files, and in [`Settings`].
    pub fn key(&self) -> String {
        self.name.replace('-', "_")
    }

    /// All options, one for each field of [`Settings`].
    pub const ALL: [Self; 10] = [
        Self {
            name: "method",
            meaning: "integration method: see \"pliant methods\"",
            value_name: "METHOD",
            value: SettingsValue::Word(
                || Method::ALL.map(Method::name).into(),
                |settings, word| word.parse().map(|method| settings.method = method),
            ),
        },
        Self {
            name: "rtol",
            meaning: "relative tolerance (no unit)",
            value_name: "RTOL",
            value: SettingsValue::Number(|settings, rtol| settings.rtol = rtol),
        },
        Self {
            name: "atol-position",
            meaning: "absolute tolerance of displacements (m)",
            value_name: "METRES",
            value: SettingsValue::Number(|settings, atol| settings.atol_position = Some(atol)),
        },
        Self {
            name: "atol-velocity",
            meaning: "absolute tolerance of velocities (m/s)",
            value_name: "METRES/SECOND",
            value: SettingsValue::Number(|settings, atol| settings.atol_velocity = Some(atol)),
        },
        Self {
            name: "alpha",
            meaning: "rate at which errors of constraints decay (1/s)",
            value_name: "1/SECONDS",
            value: SettingsValue::Number(|settings, alpha| settings.alpha = alpha),
        },
        Self {
            name: "max-order",
            meaning: "highest order of a multistep method, order of arkode's",
            value_name: "ORDER",
            value: SettingsValue::Count(|settings, order| {
                settings.max_order = Some(u32::try_from(order).unwrap_or(u32::MAX));
            }),
        },
        Self {
            name: "stability-limit-detection",
            meaning: "whether BDF lowers its order where stability bounds its steps",
            value_name: "true|false",
            value: SettingsValue::Flag(|settings, flag| settings.stability_limit_detection = flag),
        },
        Self {
            name: "contact-events",
            meaning: "how contact events are met: auto, step-over or locate",
            value_name: "WAY",
            value: SettingsValue::Word(
                || ContactEvents::ALL.map(ContactEvents::name).into(),
                |settings, word| word.parse().map(|way| settings.contact_events = way),
            ),
        },
        Self {
            name: "max-step",
            meaning: "longest step (s)",
            value_name: "SECONDS",
            value: SettingsValue::Number(|settings, step| settings.max_step = Some(step)),
        },
        Self {
            name: "max-steps",
            meaning: "steps that a phase may take",
            value_name: "STEPS",
            value: SettingsValue::Count(|settings, steps| settings.max_steps = steps),
        },
    ];
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each option sets its own field, and no field is without one: a new field of [`Settings`] has to
    /// be named here.
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
            assert_ne!(one, default, "{}", option.name);
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
        } = all;
        assert_eq!((method, contact_events), (Method::CentralDifference, ContactEvents::Locate));
        assert_eq!([rtol, alpha], [0.123; 2]);
        assert_eq!([atol_position, atol_velocity, max_step], [Some(0.123); 3]);
        assert_eq!((max_order, max_steps, stability_limit_detection), (Some(3), 3, true));
    }

    #[test]
    fn words_that_mean_nothing_are_refused() {
        for option in SettingsOption::ALL {
            if let SettingsValue::Word(words, set) = option.value {
                let error = set(&mut Settings::default(), "nothing").unwrap_err().to_string();
                assert!(error.contains(&option.key()), "{error}");
                assert!(words().iter().all(|word| error.contains(word)), "{error}");
            }
        }
    }
}
