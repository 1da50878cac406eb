//! The ladder as a table: for people, for spreadsheets and for programs.

use super::Reached;
use crate::model::Rung;
use serde_json::{Value, json};
use std::fmt::Write;

/// A line a rung with what is left of the error, and a line for each repair that the scene gives nothing to do.
pub fn text(reached: &[Reached], idle: &[(Rung, &'static str)]) -> String {
    let mut text = format!("{:<28} {:>9} {:>8} {:>12} {:>12}\n", "rung", "relMSE", "FLIP", "frame, ms", "all anew, ms");
    for rung in reached {
        let errors = &rung.errors;
        let _ = writeln!(
            text,
            "{:<28} {:>9.4} {:>8.4} {:>12.1} {:>12.1}",
            rung.rung.title(),
            errors.errors.rel_mse,
            errors.flip,
            rung.frame_ms,
            rung.anew_ms
        );
    }
    for (rung, missing) in idle {
        let _ = writeln!(text, "{:<28} nothing to repair: no {missing}", rung.title());
    }
    text
}

/// A row a rung: its name, figures and the command that makes its picture.
pub fn csv(reached: &[Reached]) -> String {
    let mut text = String::from("rung,rel_mse,rmse,mae,flip,frame_ms,anew_ms,command\n");
    for rung in reached {
        let errors = &rung.errors.errors;
        let command = rung.tile.command(0.0).replace('"', "\"\"");
        let figures = [errors.rel_mse, errors.rmse, errors.mae, rung.errors.flip, rung.frame_ms, rung.anew_ms];
        let figures = figures.map(|figure| figure.to_string()).join(",");
        let _ = writeln!(text, "{},{figures},\"{command}\"", rung.rung.name());
    }
    text
}

/// One object with all that is known of each rung.
pub fn json(reached: &[Reached], idle: &[(Rung, &'static str)]) -> Value {
    let rung = |of: &Reached| {
        let errors = &of.errors.errors;
        json!({
            "name": of.rung.name(), "title": of.rung.title(), "text": of.rung.text(), "slide": of.rung.slide(),
            "relmse": errors.rel_mse, "rmse": errors.rmse, "mae": errors.mae, "flip": of.errors.flip,
            "frame_ms": of.frame_ms, "anew_ms": of.anew_ms,
            "spp": of.tile.facts.spp, "made_by": of.tile.made_by, "command": of.tile.command(0.0),
        })
    };
    let idle = idle.iter().map(|(rung, missing)| json!({ "name": rung.name(), "missing": missing }));
    json!({ "rungs": reached.iter().map(rung).collect::<Vec<_>>(), "idle": idle.collect::<Vec<_>>() })
}

/// A rung's name with its place: "03-sky".
pub fn numbered(index: usize, rung: Rung) -> String {
    format!("{index:02}-{}", rung.name())
}
