//! Values, derivatives and errors of formulas.

use super::*;

fn value(text: &str, t: f64) -> f64 {
    Formula::parse(text).unwrap_or_else(|error| panic!("{text}: {error}")).at(t).0[0]
}

/// The rules of mathematics, where programs are known to differ: signs and powers, powers of powers.
#[test]
fn they_mean_what_mathematics_does() {
    let t = 0.3_f64;
    for (text, expected) in [
        ("-t^2", -0.09),
        ("(-t)^2", 0.09),
        ("2^3^2", 512.0),
        ("2^-1", 0.5),
        ("-2^-2", -0.25),
        ("8/4/2", 1.0),
        ("1-2-3", -4.0),
        ("1 - -2", 3.0),
        ("+3", 3.0),
        ("2*3+4*5", 26.0),
        ("1e-3*t", 3e-4),
        ("1.5E+2 + .5 + 2.", 152.5),
        ("2*e", 2.0 * std::f64::consts::E),
        ("2000*sin(2*pi*3*t)", 2000.0 * (std::f64::consts::TAU * 3.0 * t).sin()),
        ("min(t, 0.1) + max(t, 0.1)", 0.4),
        ("5*step(t-0.2) + 7*step(0.2-t)", 5.0),
        ("abs(-t) / sqrt(t^2)", 1.0),
        ("ln(exp(t)) + log10(10^t)", 0.6),
        ("atan(tan(t)) + asin(sin(t)) + acos(cos(t))", 0.9),
        ("cosh(t)^2 - sinh(t)^2 + tanh(0)", 1.0),
    ] {
        let found = value(text, t);
        assert!((found - expected).abs() <= 1e-14 * expected.abs(), "{text}: {found} {expected}");
    }
}

/// Derivatives, against central differences with h = 1e-5, whose error is h^2/6 times third and fourth
/// derivatives, 4e5 at most here (of t^-1.5 at 0.2), and round-off over h.
#[test]
fn derivatives_are_those_of_the_values() {
    for text in [
        "sin(3*t)*cos(t) + tan(t/2)",
        "asin(t/2) - acos(t/3) + atan(2*t)",
        "sinh(t) + cosh(2*t) - tanh(t)",
        "exp(-t^2) + ln(1+t) + log10(2+t)",
        "sqrt(1+t)/(2-t) - t^3 + t^-1.5",
        "2^t + t^t + (1+t)^(2*t)",
        "0.01*(1 - cos(2*pi*t))/2",
        "-3*t + 4 - t*t*t/7",
        "min(t, 2*t) + max(t^2, -1) + abs(t)*step(t)",
    ] {
        let formula = Formula::parse(text).unwrap();
        let h = 1e-5;
        for t in [0.2, 0.7, 1.1] {
            let [behind, at, ahead] = [t - h, t, t + h].map(|t| formula.at(t).0);
            for k in 0..2 {
                let slope = (ahead[k] - behind[k]) / (2.0 * h);
                let apart = (at[k + 1] - slope).abs();
                assert!(apart < 1e-5, "{text}: derivative {k} at {t} s off by {apart:e}");
            }
        }
    }
}

/// Where a number is 0 or constant, its derivatives do not become NaN by 0 times infinity.
#[test]
fn derivatives_at_the_start() {
    for (text, expected) in [
        ("t", [0.0, 1.0, 0.0]),
        ("t^2", [0.0, 0.0, 2.0]),
        ("t^3", [0.0; 3]),
        ("3*t^1", [0.0, 3.0, 0.0]),
        ("sqrt(0)", [0.0; 3]),
        ("0^2 + t", [0.0, 1.0, 0.0]),
    ] {
        assert_eq!(Formula::parse(text).unwrap().at(0.0).0, expected, "{text}");
    }
}

#[test]
fn mistakes_are_told_with_their_place() {
    for (text, parts) in [
        ("", &["expected a number", "found the end"][..]),
        ("2*(3+t", &["expected )", "found the end"]),
        ("2*3)", &["expected an operator", "')' at character 4"]),
        ("2 t", &["expected an operator", "'t' at character 3"]),
        ("2*sinn(t)", &["unknown word \"sinn\"", "sin"]),
        ("sin t", &["expected ( after sin", "'t' at character 5"]),
        ("min(1)", &["expected a comma", "min takes two numbers"]),
        ("sin(1, 2)", &["expected )", "',' at character 6"]),
        ("3*/2", &["expected a number", "'/' at character 3"]),
        ("1e999", &["finite number"]),
        (".", &["finite number"]),
        ("t = 3", &["expected an operator", "'='"]),
        ("2*\u{3c0}", &["unknown word \"\u{3c0}\"", "pi"]),
        (&"(".repeat(100_000), &["nested more than 32 deep"]),
        (&"-".repeat(100_000), &["nested more than 32 deep"]),
        (&"2^".repeat(100_000), &["nested more than 32 deep"]),
    ] {
        let error = Formula::parse(text).unwrap_err();
        parts.iter().for_each(|part| assert!(error.contains(part), "{text:.20}: {error}"));
    }
    assert_eq!(Formula::parse("max(t, 0)").unwrap().kink(), Some("max"));
    assert_eq!(Formula::parse("sin(t)").unwrap().kink(), None);
}
