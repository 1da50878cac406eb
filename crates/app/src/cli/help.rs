//! The text of `--help`.

/// What `visavis --help` prints.
pub const HELP: &str = "\
Visavis: the rasterised fake of a scene face to face with its path-traced truth.

visavis [SCENE]                  open the viewer; SCENE is whitted, cornell, hard/NAME or a .toml file (default
                                 whitted); hard/? lists the hard ones
    --theme dark|projector       projector: black on white, large type (default dark)
    --device auto|cpu|gpu        where rays are traced at first; auto is the gpu, but the cpu where the adapter is software
    --frame-stats                print at the end what a frame cost the window's thread (egui, tessellation, uploads) and
                                 how long it was from frame to frame while dragging
visavis render SCENE -o OUT      render to OUT, .png (display-transformed) or .exr (linear, settings in the header)
    --from FILE                  make the picture in FILE (.png or .exr of this program) again; other options change it
    --technique raster|whitted|path
                                 the fake, Whitted's trees of rays or the truth (default path)
    --device auto|cpu|gpu        where: the fake needs the gpu; auto traces rays on the gpu if that is no software and there
                                 is enough to do (2^24 samples), else on the cpu (default auto)
    --size WxH                   pixels (default 1280x720)
    --eye X,Y,Z --target X,Y,Z --fov DEG
                                 camera (default the scene's)
    --refraction-ratio R         index outside over inside of all glass, 0.001 to 1000 (default the scene's)
    --exposure EV                stops added before display, PNG only (default 0)
    --errors                     measure the picture against the scene's reference, which is made if it is not there
    --json                       print one JSON object about the result on stdout
  whitted and path:
    --spp N                      samples per pixel (default 64)
    --time SECONDS               stop after this long, or at --spp if that is given and comes first
    --sampler independent|sobol  where random numbers come from (default sobol)
    --sun-radius DEG             angular radius of the sun, 0 is a delta light (default the scene's)
    --lanes avx512|avx2|array|scalar
                                 what rays are traced in: the same picture, sooner or later (default the widest)
    --seed N                     selects one of 2^32 independent pictures (default 1)
  path:
    --bounces N|inf              scattering vertices after the first; 0 is direct light (default inf)
    --roulette P|throughput|P+throughput|off
                                 probability to survive a vertex, P in (0, 1] (default throughput)
    --estimator uniform|cosine|light|mis|uniform-light|uniform-mis
                                 directions uniform or cosine-weighted, light found by chance, by sampling or by both,
                                 weighted (default light; mis where there is rough metal)
    --branches N                 directions at each diffuse vertex, with a limit of bounces (default 1)
  whitted:
    --depth N                    specular scatterings along a branch, 0 to 64 (default 8)
    --glass-shadows opaque|clear whether glass stops light (default opaque)
    --shadow-rays N              to each lamp, 1 to 1024 (default 1)
    --ambient A                  ambient light, 0 to 1; also the fake's (default the scene's)
  the fake:
    --fake fair|as-taught        on the truth's data, linear; or as the tutorial's viewer drew it (default fair)
    --shading three|phong|blinn-phong
                                 whose highlight (default three)
    --reflectivity R             share of the surroundings in fake glass, 0 to 1 (default the scene's)
    --shininess S                exponent of every highlight, 0 to 1000 (default the scene's)
    --ambient A                  ambient light, 0 to 1; fair scales the sky's by it (default the scene's)
    --cube-map N                 texels along a side of a cube map's face, 4 to 2048 (default the scene's)
    --shadow-map N               texels along a side of the shadow map, 16 to 4096 (default the scene's)
    --shadow-filter hard|pcf|pcf-soft
                                 how the shadow map is looked up (default pcf-soft)
    --shadow-bias B              added to depths before they are compared, -0.1 to 0.1 (default 0)
    --segments N                 segments of a sphere, 3 to 512 (default the scene's)
    --show picture|cube-faces|shadow-map
                                 the picture, or a map that it is made from (default picture)
visavis compare A B              how far picture A is from reference B (.exr or .png): RMSE, relMSE, MAE, bias, FLIP,
                                 HDR-FLIP; B's own noise where it is a reference of this program
visavis compare A                the same against the reference of what A's records say that it shows
    --heatmap OUT                draw the errors to OUT: .png in colour with a colour bar, or .exr with both pictures
                                 and every map as layers
    --map signed|absolute|relative|squared-relative|flip
                                 which errors the map shows (default absolute)
    --scale E                    error at the end of the map's scale (default fitted to the map)
    --exposure EV                stops added before FLIP looks (default 0)
    --json                       as one JSON object
visavis reference SCENE -o OUT   make or fetch the reference of a scene: OUT.exr with its standard error as a layer
    --noise R                    until its own relMSE is R or less (default 1e-5)
    --time SECONDS               or this long was spent on it, in all (default 120; without limit if --noise is given)
    --size --eye --target --fov --refraction-ratio --sun-radius
                                 as for render
visavis reference                where references are kept, how many, their size and its limit
    --clear                      throw them away
visavis bench -o DIR             speed against error of every technique: one HTML page, its SVG plots, CSV tables; run
                                 again after an interruption, it goes on (docs/bench.md says what each number means)
    --quick                      as small as fits into a minute on an idle machine; without: half an hour on two fast cores
    --time SECONDS               as small as fits into this long
    --scene cornell,whitted      these scenes alone
    --peer FILE.csv              further lines from another renderer, may be repeated; columns name,scene,spp,seconds,
                                 relmse; scene is cornell, whitted-sun-0 or whitted-sun-2.5
visavis check                    every hard case: expected, measured, tolerance, verdict; exit code 1 if one fails
    --quick                      coarser, within a minute
    --case N,N,...               these cases alone
    --device auto|cpu|gpu        what is checked; the gpu renders 22 of the 24 cases (default auto: the cpu)
    --lanes L                    as for render
    --json                       one JSON object on stdout
visavis info                     adapters, limits, what would be used and why
visavis --help, --version

References lie in the system's folder for caches, or in VISAVIS_CACHE; VISAVIS_CACHE_MIB limits their size (default 1024).
Exit code: 0 done, 1 failed (one line on stderr), 2 wrong usage.
In the window: drag the line to wipe, drag the picture to orbit (Shift: pan, wheel: dolly, Ctrl+wheel: zoom), T swaps A and
B, 1 2 3 4 5 show A, B, wipe, side by side, error map, P pauses, R restarts, C resets the camera, H hides the panel, Ctrl+Z undoes,
Ctrl+S saves and Ctrl+C copies the picture as seen, Ctrl+Q quits, ? shows all keys.
";

/// What `visavis --version` prints.
pub const VERSION: &str = concat!("visavis ", env!("CARGO_PKG_VERSION"), "\n");
