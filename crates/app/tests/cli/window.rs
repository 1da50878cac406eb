//! What the window is opened with.

use super::*;

#[test]
fn options_of_the_window_are_those_of_render_and_faults_name_the_word() {
    for (arguments, words) in [
        (
            &["--a", "rastr"][..],
            &["--a rastr", "expected a technique (raster, whitted, path, photon, light-tracing, metropolis, normals)"]
                [..],
        ),
        (&["--a", "raster,spp=4"], &["spp is no setting of raster"]),
        (&["--b", "path,spp=0"], &["--b path,spp=0", "a whole number from 1"]),
        (&["--b", "path,branches=4"], &["--b path,branches=4"]),
        (&["--view", "both"], &["--view both", "a, b, wipe, side or map"]),
        (&["--against", "truth"], &["--against truth", "other or reference"]),
        (&["--exposure", "0,5"], &["--exposure 0,5", "stops from -30 to 30"]),
        (&["--sun-radius", "90"], &["--sun-radius 90", "from 0 to below 90"]),
        (&["--size", "8x8"], &["--size"]),
        (&["--a", ""], &["--a ''", "a word is empty"]),
        (&["--a", "2e-0-bounce"], &["did you mean 2e-0-bounces?"]),
        (&["--b", "spp=4,spp=5"], &["spp=4 and spp=5 both say spp"]),
        (&["--a", "raster", "--a", "path"], &["--a path", "given twice"]),
        (&["--b", "received=0"], &["--b received=0", "a port from 1 to 65535"]),
        (&["--b", "received,spp=4"], &["--b received,spp=4", "expected received, or received=PORT"]),
        (&["--b", "recieved"], &["another program's picture (picture=FILE, received, received=PORT), a preset ("]),
        (&["--b", "picture=mine.gif"], &["--b picture=mine.gif", "ends in .png or .exr"]),
        (&["--b", "received", "--b", "path"], &["--b path", "given twice"]),
        (&["--view", "A"], &["--view A", "did you mean a?"]),
        (&["--view", "side-by-side"], &["did you mean side?"]),
        (&["--view", ""], &["--view ''", "a, b, wipe"]),
        (&["--theme", "Light"], &["did you mean light?"]),
        (&["--slide", "2e-0"], &["--slide 2e-0", "did you mean 2e-0-1?"]),
        (&["--slide", "2c", "--slide", "2b"], &["--slide 2b", "--slide 2c"]),
        (&["cornell", "--slide", "2c"], &["cornell --slide 2c", "the scene of this slide is cornell", "leave one"]),
    ] {
        assert_refused(arguments, 2, words);
    }
    let lecture = "--a raster,as-taught --b path,spp=64,bounces=2,mis --view map --against reference --exposure -1 \
                   --refraction-ratio 0.6 --sun-radius 0 --eye 1,2,3 --target 0,0,0 --fov 30";
    let arguments: Vec<&str> = ["whitted"].into_iter().chain(lecture.split(' ')).collect();
    assert_refused(&arguments, 1, &["no window can be opened here"]);
    for prepared in [
        &["--a", "2e-0-bounces", "--b", "fair"][..],
        &["--a", "picture=mine.exr", "--b", "received=14159"],
        &["--slide", "2e-0-1", "--a", "2e-0-bounces,spp=64"],
    ] {
        assert_refused(prepared, 1, &["no window can be opened here"]);
    }
    let told = visavis(&["whitted"]);
    let line = String::from_utf8_lossy(&told.stderr);
    assert!(line.contains("no window can be opened here") && !line.contains(".rs:"), "{line}");
}

/// What is no scene is refused before there is a window.
#[test]
fn a_picture_that_says_nothing_is_no_scene_to_open() {
    let folder = TestFolder::new();
    for (name, word) in [("foreign.png", "a picture that visavis has saved"), ("foreign.exr", "open its scene")] {
        let file = folder.file(name);
        let image = film::Image::new(1, 1, [film::Vec3::ONE]).expect("a pixel");
        let kind = image_file::Kind::of(&file).expect("a kind");
        let bytes = image_file::encode(kind, &image, &film::DisplayTransform::default(), &Vec::new());
        std::fs::write(&file, bytes.expect("a picture")).expect("a file");
        assert_refused(&[file.to_str().expect("a plain path")], 1, &[word, name]);
    }
    assert_refused(&["gone.png"], 1, &["gone.png"]);
    let made = folder.file("made.png");
    let made = made.to_str().expect("a plain path");
    assert!(visavis(&["render", "cornell", "-o", made, "--size", "4x4", "--spp", "1"]).status.success());
    assert_refused(&[made], 1, &["no window can be opened here"]);
}

#[test]
fn a_session_opens_a_window_alone_and_a_faulty_one_is_refused_with_its_place() {
    let folder = TestFolder::new();
    let [good, bad] = ["good.toml", "bad.toml"].map(|name| folder.file(name));
    std::fs::write(&good, "session = 1\nscene = \"cornell\"\n").expect("a file");
    std::fs::write(&bad, "session = 1\nscene = \"cornell\"\n[panes.B]\nspp = 0\n").expect("a file");
    let [good, bad] = [&good, &bad].map(|file| file.to_str().expect("a plain path"));
    assert_refused(&[good], 1, &["no window can be opened here", "use: visavis render cornell -o out.png"]);
    assert_refused(&[bad], 1, &["bad.toml:4:7: spp=0: expected a whole number from 1"]);
    let out = folder.file("a.png");
    let render = ["render", good, "-o", out.to_str().expect("a plain path")];
    assert_refused(&render, 1, &["good.toml", "this is a session, which the window opens"]);
}
