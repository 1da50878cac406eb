//! The ladder in a session's file: which repairs are climbed, in which order, and what is shown of it.

use super::table::{Entry, Fault, Table, fault};
use super::write::Lines;
use crate::model::{LadderSettings, LadderShows, Order, Rung};
use raster::Repairs;
use scene::edit::quoted;

/// Nothing where nobody has looked at it.
pub fn lines(ladder: &LadderSettings) -> Lines {
    if *ladder == LadderSettings::default() {
        return Vec::new();
    }
    let LadderSettings { repairs, order, selected, shows } = ladder;
    vec![
        ("repairs", quoted(&repairs.to_string())),
        ("order", quoted(order.name())),
        ("rung", quoted(selected.name())),
        ("show", quoted(shows.name())),
    ]
}

/// # Errors
/// Whatever is wrong of it, with its place.
pub fn read(mut table: Table) -> Result<LadderSettings, Fault> {
    let usual = LadderSettings::default();
    let rungs: Vec<Rung> = Rung::all().collect();
    let ladder = LadderSettings {
        repairs: table.read("repairs", repairs)?.unwrap_or(usual.repairs),
        order: table.read("order", |entry| entry.one_of(&Order::ALL, Order::name))?.unwrap_or(usual.order),
        selected: table.read("rung", |entry| entry.one_of(&rungs, Rung::name))?.unwrap_or(usual.selected),
        shows: table.read("show", |entry| entry.one_of(&LadderShows::ALL, LadderShows::name))?.unwrap_or(usual.shows),
    };
    table.end()?;
    Ok(ladder)
}

fn repairs(entry: Entry) -> Result<Repairs, Fault> {
    let expected = "repairs with + between, none or all";
    let text = entry.text(expected)?;
    Repairs::parse(&text).or_else(|name| fault(&entry.at, format!("repairs: {name} is none: expected {expected}")))
}
