//! Tests of what is found, and of when it is found anew.

use super::*;
use scene::Vec3;
use std::sync::Weak;
use std::time::{Duration, Instant};

fn wish(scene: &Arc<Scene>, outlined: &[u32]) -> ObjectsWish {
    ObjectsWish {
        scene: scene.clone(),
        camera: scene.camera,
        size: (121, 80),
        outlined: outlined.into(),
        looked_into: None,
    }
}

fn scene() -> Arc<Scene> {
    Arc::new(scene::builtin::named("whitted").expect("a built-in scene"))
}

struct Asking {
    objects: Objects,
    threads: Arc<Threads>,
}

impl Asking {
    fn new() -> Self {
        Asking { objects: Objects::default(), threads: Arc::new(Threads::all()) }
    }

    fn ask(&mut self, wish: Option<&ObjectsWish>) {
        let wake: Wake = Arc::new(|| ());
        self.objects.follow(wish, &self.threads, &wake);
    }

    fn found(&self) -> FoundObjects {
        until(|| self.objects.collect()).expect("no fault")
    }
}

fn until<T>(ready: impl Fn() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(found) = ready() {
            return found;
        }
        assert!(start.elapsed() < Duration::from_secs(120), "nothing came");
        std::thread::yield_now();
    }
}

#[test]
fn another_choice_in_the_same_view_has_another_outline_and_no_new_map() {
    let (scene, mut asking) = (scene(), Asking::new());
    asking.ask(Some(&wish(&scene, &[])));
    let first = asking.found();
    assert_eq!((first.map.size, first.map.shapes.len()), ((61, 40), 61 * 40));
    assert!(first.outline.is_none() && first.along.is_none());
    let seen = first.map.shape_at([0.5, 0.6]).expect("a shape in the middle") as u32;
    let chosen = wish(&scene, &[seen]);
    asking.ask(Some(&chosen));
    let second = asking.found();
    assert!(Arc::ptr_eq(&first.map, &second.map));
    assert_eq!(second.outline.expect("an outline").size, (61, 40));
    asking.ask(Some(&chosen));
    assert!(asking.objects.collect().is_none(), "nothing else was asked for");
    asking.objects.show_again();
    asking.ask(Some(&chosen));
    assert!(Arc::ptr_eq(&first.map, &asking.found().map), "told again, but not found again");
}

#[test]
fn a_place_that_is_looked_into_begins_with_what_the_map_shows_there() {
    let (scene, mut asking) = (scene(), Asking::new());
    for at in [[0.5, 0.6], [0.31, 0.42], [0.02, 0.03], [1.0, 1.0]] {
        asking.ask(Some(&ObjectsWish { looked_into: Some(at), ..wish(&scene, &[]) }));
        let FoundObjects { map, along, .. } = asking.found();
        let along = along.expect("what is there");
        assert_eq!(along.at, at);
        assert_eq!(along.shapes.first().map(|shape| *shape as usize), map.shape_at(at), "{at:?}");
    }
}

/// The map has half the picture's pixels: along edges of shapes its pixels' middles show others than the picture's do.
#[test]
fn along_the_edges_of_shapes_too_it_is_the_maps_pixel_that_is_looked_into() {
    let (scene, mut finder) = (scene(), Finder::new(Arc::new(Threads::all())));
    let (columns, rows) = (37, 23);
    for place in 0..columns * rows {
        let [column, row] = [place % columns, place / columns];
        let at = [(column as f32 + 0.3) / columns as f32, (row as f32 + 0.3) / rows as f32];
        let wish = ObjectsWish { looked_into: Some(at), ..wish(&scene, &[]) };
        let FoundObjects { map, along, .. } = finder.find(&wish, &|| false).expect("what is there");
        let first = along.expect("what is there").shapes.first().map(|shape| *shape as usize);
        assert_eq!(first, map.shape_at(at), "{at:?}");
    }
}

#[test]
fn an_answer_that_comes_after_another_question_is_dropped() {
    let (scene, mut objects, threads) = (scene(), Objects::default(), Arc::new(Threads::all()));
    let (tell, told) = std::sync::mpsc::channel();
    let wake: Wake = Arc::new(move || _ = tell.send(()));
    objects.follow(Some(&wish(&scene, &[])), &threads, &wake);
    told.recv_timeout(Duration::from_secs(120)).expect("an answer");
    // it is there, and nobody has taken it yet
    let all: Vec<u32> = (0..scene.shapes.len() as u32).collect();
    objects.follow(Some(&wish(&scene, &all)), &threads, &wake);
    let found = until(|| objects.collect()).expect("no fault");
    assert!(found.outline.is_some(), "of what was asked for last");
}

#[test]
fn the_scene_stays_ready_while_the_camera_moves_and_another_scene_takes_its_place() {
    let (scene, other) = (scene(), scene());
    let mut finder = Finder::new(Arc::new(Threads::all()));
    let first = finder.find(&wish(&scene, &[]), &|| false).expect("a map");
    let mut moved = wish(&scene, &[]);
    moved.camera.eye += Vec3::new(0.3, 0.1, 0.0);
    let ready = |finder: &Finder| finder.ready.as_ref().map(|(_, tracer)| Arc::downgrade(tracer)).expect("a scene");
    let (before, second) = (ready(&finder), finder.find(&moved, &|| false).expect("a map"));
    assert!(before.ptr_eq(&ready(&finder)) && before.strong_count() == 1, "made ready once");
    assert!(first.map.shapes != second.map.shapes && second.map.camera == moved.camera);
    assert!(finder.find(&moved, &|| true).is_some(), "there is nothing to do for it");
    assert!(finder.find(&wish(&other, &[]), &|| true).is_none(), "ended before it began");
    finder.find(&wish(&other, &[]), &|| false).expect("a map");
    assert_eq!(before.strong_count(), 0, "the other scene takes its place");
}

#[test]
fn while_parts_are_not_looked_at_nothing_of_them_is_kept() {
    let (scene, mut asking) = (scene(), Asking::new());
    asking.ask(Some(&wish(&scene, &[])));
    let map: Weak<ObjectMap> = Arc::downgrade(&asking.found().map);
    let kept = Arc::downgrade(&scene);
    drop(scene);
    asking.objects.collect();
    asking.ask(None);
    until(|| (map.strong_count() == 0 && kept.strong_count() == 0).then_some(()));
    assert!(asking.objects.collect().is_none());
}
