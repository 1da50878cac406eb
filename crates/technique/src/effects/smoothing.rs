//! Takes out what is too small to be outlined: speckles of chance, and parts that no label would fit on.

use super::{Effect, EffectMap};

/// How often each cell takes the effect of most around it.
const ROUNDS: usize = 2;

/// Parts of fewer cells than this share of all go to what is around them.
const LEAST_PART: f32 = 0.0004;

/// The same map with borders that run smoothly, and without specks.
pub fn smoothed(mut map: EffectMap) -> EffectMap {
    for _ in 0..ROUNDS {
        map.effects = (0..map.effects.len()).map(|cell| most_around(&map, cell)).collect();
    }
    without_specks(map)
}

/// The effect of most of the nine cells about one; its own, unless five of them agree.
fn most_around(map: &EffectMap, cell: usize) -> Effect {
    let (width, height) = (map.size.0 as usize, map.size.1 as usize);
    let (x, y) = (cell % width, cell / width);
    let mut counts = [0u8; Effect::ALL.len()];
    for v in y.saturating_sub(1)..=(y + 1).min(height - 1) {
        for u in x.saturating_sub(1)..=(x + 1).min(width - 1) {
            counts[map.effects[v * width + u] as usize] += 1;
        }
    }
    Effect::ALL.into_iter().find(|effect| counts[*effect as usize] >= 5).unwrap_or(map.effects[cell])
}

/// Gives each small part the effect that most cells beside it have.
fn without_specks(mut map: EffectMap) -> EffectMap {
    let least = (LEAST_PART * map.effects.len() as f32) as usize;
    let mut parts = parts(&map);
    parts.sort_by_key(Vec::len);
    for part in parts.into_iter().take_while(|part| part.len() < least) {
        let own = map.effects[part[0]];
        let mut counts = [0u32; Effect::ALL.len()];
        let beside = part.iter().flat_map(|cell| beside(map.size, *cell)).map(|cell| map.effects[cell]);
        beside.filter(|effect| *effect != own).for_each(|effect| counts[effect as usize] += 1);
        let most = Effect::ALL.into_iter().max_by_key(|effect| counts[*effect as usize]);
        if let Some(effect) = most.filter(|effect| counts[*effect as usize] > 0) {
            part.into_iter().for_each(|cell| map.effects[cell] = effect);
        }
    }
    map
}

/// The cells of each connected part of one effect.
pub fn parts(map: &EffectMap) -> Vec<Vec<usize>> {
    let mut known = vec![false; map.effects.len()];
    let mut parts = Vec::new();
    for first in 0..map.effects.len() {
        if std::mem::replace(&mut known[first], true) {
            continue;
        }
        let (mut part, mut next) = (vec![first], 0);
        while let Some(cell) = part.get(next).copied() {
            next += 1;
            for other in beside(map.size, cell) {
                if map.effects[other] == map.effects[first] && !std::mem::replace(&mut known[other], true) {
                    part.push(other);
                }
            }
        }
        parts.push(part);
    }
    parts
}

/// The cells that share a side with one.
fn beside((width, height): (u32, u32), cell: usize) -> impl Iterator<Item = usize> {
    let (width, height) = (width as usize, height as usize);
    let (x, y) = (cell % width, cell / width);
    let left = (x > 0).then(|| cell - 1);
    let right = (x + 1 < width).then_some(cell + 1);
    let above = (y > 0).then(|| cell - width);
    let below = (y + 1 < height).then_some(cell + width);
    [left, right, above, below].into_iter().flatten()
}
