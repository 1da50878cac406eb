//! The tables as CSV: every picture, and every measurement over its seeds. Columns are documented in docs/bench.md.

use crate::line::Line;
use crate::measure::{Bias, BiasTest, Measurement};
use crate::plan::Part;
use crate::summary::PartSummary;
use compare::{Fit, Range};

/// A row for each picture.
pub fn pictures(parts: &[(Part, Vec<Line>)], measurements: &[Measurement]) -> String {
    let mut text = String::from(
        "part,line,device,sampler,width,height,spp,seed,seconds,rmse,relmse,mae,bias,flip,samples,rays,cut_paths,nonfinite,\
         tail_weight,reference_rmse,reference_relmse\n",
    );
    for m in measurements {
        let Some((part, lines)) = parts.iter().find(|(part, _)| part.name == m.part) else { continue };
        let Some(line) = lines.iter().find(|line| line.name() == m.line) else { continue };
        let (device, sampler) = (line.device().name(), line.sampler());
        let (reference_rmse, reference_rel_mse) = (m.reference.mse.sqrt(), m.reference.rel_mse);
        for p in &m.pictures {
            text += &format!(
                "{},{},{device},{sampler},{},{},{},{},{:.6},{:e},{:e},{:e},{:e},{:e},{},{},{},{},{:e},{:e},{:e}\n",
                field(&m.part),
                field(&m.line),
                part.width,
                part.height,
                m.spp,
                p.seed,
                p.seconds,
                p.rmse,
                p.rel_mse,
                p.mae,
                p.bias,
                p.flip,
                p.samples,
                p.rays,
                p.cut_paths,
                p.nonfinite,
                p.tail_weight,
                reference_rmse,
                reference_rel_mse
            );
        }
    }
    text
}

/// A row for each measurement, and for each of the peers'.
pub fn summary(parts: &[PartSummary]) -> String {
    let of_range = |name: &str| format!("{name},{name}_low,{name}_high");
    let ranges = ["seconds", "rmse", "relmse", "mae", "bias", "flip"].map(of_range).join(",");
    let mut text = format!(
        "part,line,device,sampler,spp,seeds,{ranges},slope,slope_error,relative_slope,relative_slope_error,\
         last_slope,efficiency,samples_per_second,\
         rays_per_second,bias_squared,bias_squared_error,smallest_noticed_bias,relative_bias_squared,\
         relative_bias_squared_error,smallest_noticed_relative_bias,below_reference_noise,nonfinite,cut_paths,\
         tail_weight,reference_spp,reference_rmse,reference_relmse,reference_tail_weight,reference_reliable\n"
    );
    for part in parts {
        let worth = part.worth;
        let reference = format!(
            "{},{:e},{:e},{:e},{}",
            worth.spp,
            worth.mse.sqrt(),
            worth.rel_mse,
            worth.tail_weight,
            worth.is_reliable()
        );
        for curve in &part.curves {
            let slope = |fit: Option<Fit>| fit.map_or(",".into(), |f| format!("{:e},{:e}", f.slope, f.slope_error));
            let slopes = format!("{},{}", slope(curve.slope), slope(curve.relative_slope));
            let last_slope = curve.last_slope.map(number).unwrap_or_default();
            for p in &curve.points {
                let ranges = [p.seconds, p.rmse, p.rel_mse, p.mae, p.bias, p.flip].map(range).join(",");
                let test = |test: BiasTest, mean: f64| {
                    format!("{:e},{:e},{:e}", test.bias_squared, test.standard_error, test.power() / mean)
                };
                let both = |bias: Bias| format!("{},{}", test(bias.absolute, worth.mean), test(bias.relative, 1.0));
                let bias = p.bias_test.map_or(",,,,,".into(), both);
                text += &format!(
                    "{},{},{},{},{},{},{ranges},{slopes},{last_slope},{:e},{:e},{:e},{bias},{},{},{},{:e},{reference}\n",
                    field(&part.part.name),
                    field(&curve.line.name()),
                    curve.line.device().name(),
                    curve.line.sampler(),
                    p.spp,
                    crate::plan::SEEDS,
                    p.efficiency,
                    p.samples_per_second,
                    p.rays_per_second,
                    p.below_reference_noise,
                    p.nonfinite,
                    p.cut_paths,
                    p.tail_weight
                );
            }
        }
        for row in part.peers.iter().flat_map(|curve| &curve.rows) {
            let mut fields = vec![field(&part.part.name), field(&row.name), "peer".into(), String::new()];
            fields.extend([row.spp.to_string(), String::new(), range(Range::exactly(row.seconds)), ",,".into()]);
            fields.push(range(Range::exactly(row.rel_mse)));
            let told = fields.join(",");
            // what a peer does not tell is empty
            let columns = text.lines().next().map_or(0, |header| header.split(',').count());
            text += &format!("{told}{}\n", ",".repeat(columns.saturating_sub(told.split(',').count())));
        }
    }
    text
}

fn number(value: f64) -> String {
    format!("{value:e}")
}

fn range(range: Range) -> String {
    format!("{:e},{:e},{:e}", range.median, range.low, range.high)
}

/// A field as RFC 4180 has it.
fn field(words: &str) -> String {
    if words.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", words.replace('"', "\"\""))
    } else {
        words.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_that_would_break_a_row_are_quoted() {
        assert_eq!(field("plain"), "plain");
        assert_eq!(field("a,\"b\""), "\"a,\"\"b\"\"\"");
    }
}
