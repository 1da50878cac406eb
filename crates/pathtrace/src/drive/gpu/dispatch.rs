//! Work cut into dispatches that each fit a budget of time, so that no driver gives the device up, a window that shares
//! it stays alive, and a user who has seen enough is heard.

use super::GpuTraceError;
use super::film::{Band, GpuFilm};
use super::film_data::{MOST_SAMPLES, RenderParams};
use super::timing::{Pace, Stopwatch};
use gpu::waiting::PATIENCE;
use gpu::{Gpu, wgpu};

/// Threads of a group along x and y, as in the shaders.
pub(crate) const GROUP: u32 = 8;

/// Samples of a pixel in one dispatch where a whole picture does not fit the budget: threads whose paths end early go
/// on with their next sample, which keeps their neighbours company ...
const SAMPLES_OF_A_PART: f64 = 16.0;

/// ... as long as so many threads are left.
const FEWEST_THREADS: f64 = 4096.0;

/// What runs the dispatches of one call.
pub(crate) struct Dispatcher<'a> {
    pub gpu: &'a Gpu,
    pub pipeline: &'a wgpu::ComputePipeline,
    pub scene: &'a wgpu::BindGroup,
    /// What is bound behind the film, if anything is.
    pub map: Option<&'a wgpu::BindGroup>,
    pub stopwatch: &'a mut Stopwatch,
    pub pace: &'a mut Pace,
    /// Seconds that a dispatch may take.
    pub budget: f64,
    /// What all dispatches have taken.
    pub seconds: &'a mut f64,
    /// Dispatches on their way, oldest first: where their times are, how many samples they take, what to wait for.
    pub in_flight: Vec<(usize, f64, wgpu::SubmissionIndex)>,
    pub submitted: usize,
    /// Whether the time of a dispatch tells the device's pace.
    pub learning: bool,
}

/// Some samples of every pixel, as far as they have come: tiles from left to right in strips of rows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Pass {
    samples: u32,
    band: usize,
    row: u32,
    column: u32,
    /// Rows of the strip, once it is begun.
    strip: u32,
}

/// What one dispatch samples of a band.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Tile {
    row: u32,
    rows: u32,
    column: u32,
    columns: u32,
}

impl Pass {
    fn new(samples: u32) -> Self {
        Pass { samples, band: 0, row: 0, column: 0, strip: 0 }
    }

    /// The next tile of a band of this size, and the pass after it: as many samples as fit, in whole groups of threads.
    fn next(self, (width, height): (u32, u32), samples_that_fit: f64) -> (Tile, Self) {
        let pixels = ((samples_that_fit / f64::from(self.samples)) as u32).min(1 << 28);
        let rows = if self.column > 0 { self.strip } else { (pixels / width).max(1).next_multiple_of(GROUP) };
        // a strip that fits or not even one row of groups, which is cut into columns
        let rows = if self.column == 0 && rows > GROUP { pixels / width / GROUP * GROUP } else { rows };
        let rows = rows.min(height - self.row);
        let columns = (pixels / GROUP / GROUP * GROUP).max(GROUP);
        let columns = if rows > GROUP || pixels >= width * GROUP { width } else { columns };
        let columns = columns.min(width - self.column);
        let tile = Tile { row: self.row, rows, column: self.column, columns };
        let mut after = Pass { column: self.column + columns, strip: rows, ..self };
        if after.column == width {
            (after.row, after.column) = (self.row + rows, 0);
        }
        if after.row == height {
            (after.band, after.row) = (self.band + 1, 0);
        }
        (tile, after)
    }
}

impl Dispatcher<'_> {
    /// Brings every pixel to `until` samples, unless `stop` says so between two dispatches.
    pub fn run(
        mut self,
        film: &mut GpuFilm,
        params: RenderParams,
        until: u32,
        stop: &impl Fn() -> bool,
    ) -> Result<(), GpuTraceError> {
        self.stopwatch.restart();
        while film.samples_done < until {
            let stopped = film.pass.take();
            let goes_on = stopped.filter(|pass| film.samples_done + pass.samples <= until);
            // of a pass that was stopped and asked for more, tiles are there already: they take no time, which says
            // nothing
            self.learning = stopped.is_none() || goes_on.is_some();
            let mut pass = match goes_on {
                Some(pass) => pass,
                None => self.begin(film, until)?,
            };
            let done = film.samples_done + pass.samples;
            while let Some(band) = film.bands.get(pass.band) {
                if stop() {
                    film.pass = Some(pass);
                    return self.finish(0);
                }
                let (tile, after) = pass.next((film.width(), band.rows), self.pace.samples_that_fit());
                self.dispatch(band, RenderParams { until: done, ..params }, tile, pass.samples)?;
                pass = after;
            }
            film.samples_done = done;
        }
        self.finish(0)
    }

    /// A pass of as many samples as fit the budget with a whole picture, or some with a part of it.
    fn begin(&mut self, film: &mut GpuFilm, until: u32) -> Result<Pass, GpuTraceError> {
        let fit = self.pace.samples_that_fit();
        let whole = fit / (f64::from(film.width()) * f64::from(film.height()));
        let part = (fit / FEWEST_THREADS).clamp(1.0, SAMPLES_OF_A_PART);
        let samples = (whole.max(part) as u32).min(until - film.samples_done).min(MOST_SAMPLES);
        if film.unfolded + samples > MOST_SAMPLES {
            self.finish(0)?;
            film.fold(self.gpu)?;
        }
        film.unfolded += samples;
        Ok(Pass::new(samples))
    }

    fn dispatch(&mut self, band: &Band, asked: RenderParams, tile: Tile, samples: u32) -> Result<(), GpuTraceError> {
        let gpu = self.gpu;
        let slot = self.submitted % 2;
        let first_row = band.first_row + tile.row;
        let asked = RenderParams {
            film_row: band.first_row,
            first_row,
            end_row: first_row + tile.rows,
            first_column: tile.column,
            end_column: tile.column + tile.columns,
            ..asked
        };
        gpu.queue.write_buffer(&band.asked, 0, bytemuck::bytes_of(&asked));
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: None });
        {
            let timestamp_writes = self.stopwatch.marks(slot);
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: None, timestamp_writes });
            pass.set_pipeline(self.pipeline);
            pass.set_bind_group(0, self.scene, &[]);
            pass.set_bind_group(1, &band.group, &[]);
            if let Some(map) = self.map {
                pass.set_bind_group(2, map, &[]);
            }
            pass.dispatch_workgroups(tile.columns.div_ceil(GROUP), tile.rows.div_ceil(GROUP), 1);
        }
        self.stopwatch.collect(&mut encoder, slot);
        let index = gpu.queue.submit([encoder.finish()]);
        self.stopwatch.submitted(slot);
        self.submitted += 1;
        let work = f64::from(tile.columns) * f64::from(tile.rows) * f64::from(samples);
        self.in_flight.push((slot, work, index));
        self.finish(1)
    }

    /// Waits until at most `most` dispatches are on their way.
    fn finish(&mut self, most: usize) -> Result<(), GpuTraceError> {
        while self.in_flight.len() > most {
            let (slot, work, index) = self.in_flight.remove(0);
            if !self.gpu.wait("a part of the path traced film", Some(&index), PATIENCE)? {
                let seconds = PATIENCE.as_secs();
                return Err(GpuTraceError::Hangs(format!("a dispatch took more than {seconds} seconds")));
            }
            let seconds = self.stopwatch.seconds(slot);
            *self.seconds += seconds;
            if self.learning || seconds > self.budget {
                self.pace.learn(work, seconds, self.budget);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tiles of a pass over bands of these heights, with what fits at each step.
    fn tiles(width: u32, heights: &[u32], samples: u32, fit: impl Fn(usize) -> f64) -> Vec<(usize, Tile)> {
        let (mut pass, mut tiles) = (Pass::new(samples), Vec::new());
        while let Some(&height) = heights.get(pass.band) {
            let (tile, after) = pass.next((width, height), fit(tiles.len()));
            tiles.push((pass.band, tile));
            pass = after;
        }
        tiles
    }

    #[test]
    fn tiles_cover_every_pixel_once_however_much_fits() {
        let (width, heights) = (83, [21, 1, 40]);
        for samples in [1, 3] {
            for fit in [1.0, 70.0, 500.0, 2000.0, 1e9] {
                // also where it changes from one to the next
                for change in [1.0, 1.7, 0.6] {
                    let mut seen: Vec<Vec<u32>> = heights.iter().map(|h| vec![0; (width * h) as usize]).collect();
                    for (band, tile) in tiles(width, &heights, samples, |i| fit * f64::powi(change, i as i32 % 5)) {
                        for row in tile.row..tile.row + tile.rows {
                            for column in tile.column..tile.column + tile.columns {
                                seen[band][(row * width + column) as usize] += 1;
                            }
                        }
                    }
                    assert!(seen.iter().flatten().all(|&times| times == 1), "{samples} {fit} {change}");
                }
            }
        }
    }

    #[test]
    fn a_tile_is_no_more_than_fits_and_no_less_than_a_group() {
        let of = |fit: f64| tiles(1280, &[720], 2, |_| fit)[0].1;
        let groups = |tile: Tile| (tile.columns / 8, tile.rows / 8);
        assert_eq!(groups(of(1.0)), (1, 1));
        assert_eq!(groups(of(2.0 * 64.0 * 5.5)), (5, 1));
        assert_eq!(groups(of(2.0 * 1280.0 * 17.0)), (160, 2));
        assert_eq!(groups(of(1e9)), (160, 90));
    }
}
