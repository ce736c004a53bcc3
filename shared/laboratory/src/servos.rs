//! `robot servos`: the servos of an arm, while no group uses them.

use command_line::output::{Output, note, table};
use command_line::{Outcome, configuration};
use feetech_driver::{Condition, Done, Found, ServiceDesk};
use preflight::ArmSetup;
use service::exit::{Exit, Failure};

use crate::args::ServosArgs;

/// Looks at the servos, or does what the options say.
pub(super) fn servos(args: &ServosArgs, out: &mut Output<'_>) -> Outcome {
    let settings = configuration::settings(&args.config)?;
    let setup = ArmSetup::new(&settings)?;
    let mut desk = ServiceDesk::open(&settings, &setup.robot)?;
    if args.release {
        return done(&desk.release(), "released", out);
    }
    if args.write_calibration {
        let written =
            desk.write_calibration().map_err(|reason| Failure::new(Exit::NotReached, reason))?;
        return done(&written, "calibrated", out);
    }
    show(&desk.look(), out)
}

/// Prints what became of each servo.
fn done(all: &[Done], word: &str, out: &mut Output<'_>) -> Outcome {
    for servo in all {
        if out.is_json() {
            out.json(servo)?;
        } else {
            let result = servo
                .problem
                .as_deref()
                .map_or(word.to_owned(), |problem| format!("failed: {problem}"));
            out.line(format_args!("{:<16} {result}", servo.joint))?;
        }
    }
    let failed = all.iter().any(|servo| servo.problem.is_some());
    Ok(if failed { Exit::NotReached } else { Exit::Ok })
}

/// Prints the servos, and what is wrong with them.
fn show(all: &[Found], out: &mut Output<'_>) -> Outcome {
    if out.is_json() {
        all.iter().try_for_each(|servo| out.json(servo))?;
    } else {
        let rows: Vec<Vec<String>> = all.iter().map(row).collect();
        let heads =
            ["ID", "JOINT", "POSITION", "STEPS", "TORQUE", "SUPPLY", "HEAT", "FIRMWARE", "ERROR"];
        table(&heads, &rows).into_iter().try_for_each(|line| out.line(line))?;
    }
    let states = all.iter().filter_map(|servo| servo.state.as_ref());
    let differences: Vec<&str> =
        states.flat_map(|it| it.differences.iter().map(String::as_str)).collect();
    if !differences.is_empty() && !out.is_json() {
        note(format_args!(
            "not calibrated as the file says: {}; help: `whichone robot servos --write-calibration`",
            differences.join(", ")
        ));
    }
    let is_well = |servo: &Found| servo.state.as_ref().is_some_and(|it| it.error.is_none());
    Ok(if differences.is_empty() && all.iter().all(is_well) { Exit::Ok } else { Exit::NotReached })
}

fn row(servo: &Found) -> Vec<String> {
    let mut row = vec![servo.id.to_string(), servo.joint.clone()];
    match &servo.state {
        None => row.extend(["no answer", "", "", "", "", "", ""].map(str::to_owned)),
        Some(Condition { position, steps, holds, volts, celsius, firmware, error, .. }) => row
            .extend([
                format!("{position:.3}"),
                steps.to_string(),
                if *holds { "on" } else { "off" }.to_owned(),
                format!("{volts:.1} V"),
                format!("{celsius} °C"),
                firmware.clone(),
                error.clone().unwrap_or_else(|| "-".to_owned()),
            ]),
    }
    row
}
