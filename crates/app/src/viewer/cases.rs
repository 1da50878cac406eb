//! Hard cases: what was measured, as it comes.

use super::Viewer;
use serde_json::{Value, json};

impl Viewer {
    /// Takes what was measured since the last frame.
    pub(super) fn collect_cases(&mut self) {
        let Some(news) = self.engine.case_news() else { return };
        self.presentation.shown.cases.results.extend(news.results);
        if let Some(fault) = news.fault {
            self.model.say(Err(fault));
        }
    }

    /// What is known of the cases, for tests.
    pub(super) fn cases_dump(&self) -> Value {
        let cases = &self.presentation.shown.cases;
        let results = cases.results.iter().map(|((machine, number), result)| {
            json!({
                "case": number, "device": machine.device().name(), "rows": result.rows.len(),
                "course": format!("{:?}", result.course),
            })
        });
        json!({ "looked_at": self.model.state.cases.looked_at, "results": results.collect::<Vec<_>>() })
    }
}
