//! Makes `docs/scene-reference.md` from the structs' documentation and defaults, and fails when the file
//! differs. `BOWKNOT_ACCEPT=1 cargo test --release --workspace reference` writes it anew.

use bowknot::dynamics::{
    ClothMaterial, Environment, NewtonParams, ParticleMaterial, SolidMaterial, StrandMaterial,
};
use bowknot::scene::{
    BodyKind, BodySpec, FrictionPair, Keyframe, Material, Motion, ObstacleSpec, OutputParams, PinSpec,
    Region, RepulsionParams, SimulationParams,
};
use bowknot::shapes::{
    Ball, Cone, Cuboid, Figure, Garment, HalfSpaceShape, Lathe, Ribbon, Sheet, Tube, Wedge,
};
use bowknot::shapes::{Block, Grains, MeshArrays, Strands, TetBall, Woven};
use bowknot::twoway::{BackwardParams, ContactParams, ForwardParams, Params, StopParams};
use serde::Serialize;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// Where the structs and enums are, relative to `crates`.
const SOURCES: [&str; 37] = [
    "scene/src/params.rs",
    "scene/src/body.rs",
    "scene/src/obstacle.rs",
    "scene/src/pin.rs",
    "scene/src/kind.rs",
    "scene/src/friction.rs",
    "scene/src/motion.rs",
    "io/src/import.rs",
    "scene/src/shapes/half_space.rs",
    "scene/src/shapes/sheet.rs",
    "scene/src/shapes/tube.rs",
    "scene/src/shapes/ball.rs",
    "scene/src/shapes/cone.rs",
    "scene/src/shapes/cuboid.rs",
    "scene/src/shapes/figure/mod.rs",
    "scene/src/shapes/garment.rs",
    "scene/src/shapes/wedge.rs",
    "scene/src/shapes/lathe.rs",
    "scene/src/shapes/ribbon.rs",
    "scene/src/shapes/block.rs",
    "scene/src/shapes/tet_ball.rs",
    "scene/src/shapes/strands.rs",
    "scene/src/shapes/woven.rs",
    "scene/src/shapes/grains.rs",
    "scene/src/shapes/arrays.rs",
    "constraints/src/params.rs",
    "stepper/src/params.rs",
    "twoway/src/params.rs",
    "twoway/src/stop.rs",
    "dynamics/src/params.rs",
    "dynamics/src/material/rest_shape.rs",
    "dynamics/src/material/cloth.rs",
    "dynamics/src/material/solid.rs",
    "dynamics/src/material/strand.rs",
    "dynamics/src/material/particle.rs",
    "lcp/src/params.rs",
    "geometry/src/point.rs",
];

const HEAD: &str = "\
# Scene reference

A scene is a TOML file. Every key has a default but the meshes; unknown keys are refused. \
Units stand in \
their own
column: 1 is a plain number. Lengths are in meters, z is up. `--set KEY.PATH=VALUE` overrides a \
key of a file or of a
built-in scene; an entry of `body`, `obstacle` or `pin` is named by its index from 0 \
or by its `name`:
`--set body.sheet.material=silk`.

This page is made from the documentation of the \
structs; `BOWKNOT_ACCEPT=1 cargo test --release --workspace reference`
writes it anew.
";

struct Field {
    key: String,
    kind: String,
    doc: String,
}

struct Sources(String);

impl Sources {
    fn read() -> Self {
        let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let text = |source: &&str| fs::read_to_string(crates.join(source)).unwrap_or_default();
        Self(SOURCES.iter().map(text).collect())
    }

    /// The lines between the braces of `pub struct NAME {` or `pub enum NAME {`.
    fn body(&self, keyword: &str, name: &str) -> Option<&str> {
        let start = self.0.find(&format!("pub {keyword} {name} {{\n"))?;
        let rest = &self.0[start..];
        Some(&rest[..rest.find("\n}")?])
    }

    fn fields(&self, name: &str) -> Vec<Field> {
        let body = self.body("struct", name).unwrap_or_else(|| panic!("struct {name} is in none of SOURCES"));
        Self::documented_fields(body)
    }

    /// The fields of the variants of an enum.
    fn variant_fields(&self, name: &str) -> Vec<Field> {
        let body = self.body("enum", name).unwrap_or_else(|| panic!("enum {name} is in none of SOURCES"));
        let start = |line: &str| line.trim().ends_with(" {");
        let lines: Vec<&str> = body.lines().collect();
        let variants = (1..lines.len()).filter(|&k| start(lines[k]));
        variants
            .flat_map(|k| {
                let end = |line: &&&str| **line != "    },";
                let fields = lines[k..].iter().take_while(end).map(|line| {
                    let line = line.trim();
                    if line.starts_with("///") { line.to_owned() } else { format!("pub {line}") }
                });
                Self::documented_fields(&fields.collect::<Vec<_>>().join("\n"))
            })
            .collect()
    }

    /// The public fields in the lines of a struct after the first.
    fn documented_fields(body: &str) -> Vec<Field> {
        let (mut fields, mut doc, mut rename) = (Vec::new(), String::new(), None);
        for line in body.lines().skip(1).map(str::trim) {
            if let Some(text) = line.strip_prefix("///") {
                doc.push_str(text.trim());
                doc.push(' ');
            } else if let Some(rest) = line.split_once("rename = \"").map(|(_, rest)| rest) {
                rename = rest.split('"').next().map(str::to_owned);
            } else if let Some((key, kind)) = line.strip_prefix("pub ").and_then(|line| line.split_once(": "))
            {
                let key = rename.take().unwrap_or_else(|| key.to_owned());
                let kind = kind.trim_end_matches(',').to_owned();
                fields.push(Field { key, kind, doc: std::mem::take(&mut doc).trim().to_owned() });
            }
        }
        fields
    }

    /// Names of an enum's variants as serde has them, if `name` is an enum whose variants have no data, or
    /// named fields.
    fn variants(&self, name: &str) -> Option<Vec<String>> {
        let lower = |name: &str| {
            let mut kebab = String::new();
            for c in name.chars() {
                if c.is_uppercase() && !kebab.is_empty() {
                    kebab.push('-');
                }
                kebab.extend(c.to_lowercase());
            }
            kebab
        };
        // Variants are indented by one level, their fields by two.
        let lines = self.body("enum", name)?.lines().skip(1).filter_map(|line| line.strip_prefix("    "));
        let lines = lines.filter(|line| !line.starts_with(['/', ' ', '}', '#']));
        let names: Vec<String> =
            lines.filter_map(|line| line.strip_suffix(',').or(line.strip_suffix(" {"))).map(lower).collect();
        names
            .iter()
            .all(|name| name.chars().all(|c| c.is_lowercase() || c.is_ascii_digit() || c == '-'))
            .then_some(names)
    }
}

struct Page {
    sources: Sources,
    text: String,
}

impl Page {
    fn section(&mut self, heading: &str, about: &str) {
        let _ = write!(self.text, "\n## {heading}\n\n{about}\n");
    }

    fn head(&mut self, paper: bool) {
        let columns = if paper {
            "| key | type | unit | default | `paper` | meaning |\n|---|---|---|---|---|---|"
        } else {
            "| key | type | unit | default | meaning |\n|---|---|---|---|---|"
        };
        let _ = write!(self.text, "\n{columns}\n");
    }

    /// The rows of a struct's fields that `keep` keeps; `paper` has the other preset's values.
    fn rows<T: Serialize>(
        &mut self,
        name: &str,
        defaults: &T,
        paper: Option<&T>,
        keep: impl Fn(&str) -> bool,
    ) {
        let mut fields = self.sources.fields(name);
        fields.retain(|field| keep(&field.key));
        self.rows_of(name, &fields, defaults, paper);
    }

    /// The rows of `fields`, which stand in the table of a `T`.
    fn rows_of<T: Serialize>(&mut self, name: &str, fields: &[Field], defaults: &T, paper: Option<&T>) {
        let table = |value: &T| Table::try_from(value).expect("a table");
        let defaults = table(defaults);
        let paper_values = paper.map(table);
        for field in fields {
            let (unit, meaning) = split_unit(&plain(&field.doc), &field.kind);
            let (kind, values) = self.describe(&field.kind);
            let default = show(defaults.get(&field.key));
            // Where the text names the values already, a list of them adds nothing.
            let named =
                values.split('`').skip(1).step_by(2).all(|value| meaning.contains(&format!("`{value}`")));
            let values = if named { "" } else { &values };
            let paper = paper_values.as_ref().map(|values| {
                let value = show(values.get(&field.key));
                if value == default { String::new() } else { value }
            });
            let paper = paper.map_or_else(String::new, |value| format!(" {value} |"));
            assert!(!meaning.is_empty(), "{name}.{} has no documentation", field.key);
            let _ = writeln!(
                self.text,
                "| `{}` | {kind} | {unit} | {default} |{paper} {meaning}{values} |",
                field.key
            );
        }
    }

    /// The type of a field in words, and the values that it may have if they are few.
    fn describe(&self, kind: &str) -> (String, String) {
        let inner = kind.strip_prefix("Option<").and_then(|k| k.strip_suffix('>')).unwrap_or(kind);
        if let Some(element) = inner.strip_prefix("Vec<").and_then(|k| k.strip_suffix('>')) {
            let (element, values) = self.describe(element);
            return (format!("array of {element}"), values);
        }
        let word = match inner {
            "f64" => "number",
            "usize" | "u32" | "u64" => "integer",
            "bool" => "boolean",
            "String" => "string",
            "PathBuf" => "path",
            "Vector" | "Point" | "[f64; 3]" => "[x, y, z]",
            "[f64; 2]" => "[x, y]",
            "[usize; 3]" => "[nx, ny, nz]",
            "[u32; 2]" => "[i, j]",
            "[u32; 3]" => "[i, j, k]",
            "[u32; 4]" => "[i, j, k, l]",
            "[String; 2]" => "[name, name]",
            "Material" => "name or table",
            _ => match self.sources.variants(inner) {
                Some(variants) => {
                    let list: Vec<String> = variants.iter().map(|v| format!("`{v}`")).collect();
                    return ("name".to_owned(), format!(" One of {}.", list.join(", ")));
                }
                None => "table",
            },
        };
        (word.to_owned(), String::new())
    }
}

/// A default as TOML; nothing for tables, which have their own section, and for what is derived.
fn show(value: Option<&Value>) -> String {
    match value {
        Some(Value::Float(number)) if number.is_infinite() => format!("`{number}`"),
        Some(Value::Float(number)) if *number != 0.0 && number.abs() < 1e-3 => format!("`{number:e}`"),
        Some(Value::String(text)) if text.is_empty() => String::new(),
        Some(Value::Array(list)) if list.is_empty() => "`[]`".to_owned(),
        Some(Value::Array(list)) => {
            let list: Vec<String> = list.iter().map(|v| show(Some(v)).trim_matches('`').to_owned()).collect();
            format!("`[{}]`", list.join(", "))
        }
        None | Some(Value::Table(_)) => String::new(),
        Some(other) => format!("`{other}`"),
    }
}

/// Rustdoc links become plain code.
fn plain(doc: &str) -> String {
    let mut text = doc.replace("|", "\\|");
    while let Some(start) = text.find("[`") {
        let Some(length) = text[start..].find("`]") else { break };
        let end = start + length;
        let code = text[start + 2..end].rsplit("::").next().unwrap_or_default().to_owned();
        let mut rest = end + 2;
        if text[rest..].starts_with('(') {
            rest += text[rest..].find(')').map_or(0, |close| close + 1);
        }
        text.replace_range(start..rest, &format!("`{code}`"));
    }
    text
}

/// The unit in the first brackets, and the text without it. Numbers without brackets have unit 1.
fn split_unit(doc: &str, kind: &str) -> (String, String) {
    if let Some((before, rest)) = doc.split_once(" [")
        && let Some((unit, after)) = rest.split_once(']')
    {
        let is_unit = unit.len() < 10 && !unit.contains(',');
        if is_unit && !before.ends_with('`') {
            return (unit.to_owned(), format!("{before}{after}"));
        }
    }
    let number = ["f64", "usize", "u32", "u64"].iter().any(|word| kind.contains(word));
    (if number { "1".to_owned() } else { String::new() }, doc.to_owned())
}

fn page() -> String {
    let mut page = Page { sources: Sources::read(), text: HEAD.to_owned() };
    let all = |_: &str| true;

    page.section("[simulation]", "Time and the order of work.");
    page.head(false);
    page.rows("SimulationParams", &SimulationParams::default(), None, all);
    page.rows("Environment", &Environment::default(), None, all);

    page.section(
        "[contact]",
        "Contact and stretch limits. `preset` sets the defaults of this table, of `[solver.backward]`, \
         `[solver.forward]` and `[solver.stop]`: `fast`, the default, `quick` or `paper`, the method as the \
         paper describes it. The column \
         `paper` has its values where they differ.",
    );
    let _ =
        writeln!(page.text, "\n`quick` is for previews: as safe as `fast`, with {}.", quick_differences());
    page.head(true);
    let _ = writeln!(
        page.text,
        "| `preset` | name |  | `\"fast\"` | `\"paper\"` | Set of defaults. One of `fast`, `quick`, `paper`. \
         |"
    );
    let (fast, paper) = (Params::fast(), Params::paper());
    page.rows::<ContactParams>("ContactParams", &fast.contact, Some(&paper.contact), all);

    page.section(
        "[[contact.friction_pairs]]",
        "Friction between two bodies, in place of the geometric mean of their own.",
    );
    page.head(false);
    page.rows("FrictionPair", &FrictionPair::default(), None, all);

    page.section("[solver.newton]", "Newton's method, its linear solve, and when a time step is solved.");
    page.head(false);
    page.rows("NewtonParams", &NewtonParams::default(), None, all);
    let (fast, paper) = (&fast.solver, &paper.solver);
    page.section("[solver.backward]", "The backward step of the two-way method.");
    page.head(true);
    page.rows::<BackwardParams>("BackwardParams", &fast.backward, Some(&paper.backward), all);
    page.section("[solver.forward]", "The forward step of the two-way method, and the trust regions.");
    page.head(true);
    page.rows::<ForwardParams>("ForwardParams", &fast.forward, Some(&paper.forward), all);
    page.section("[solver.stop]", "When a collision problem counts as solved.");
    page.head(true);
    page.rows::<StopParams>("StopParams", &fast.stop, Some(&paper.stop), all);
    let fields = page.sources.variant_fields("StopRule");
    page.rows_of("StopRule", &fields, &fast.stop, Some(&paper.stop));

    page.section(
        "[solver.repulsion]",
        "Springs between surfaces that are near at the start of a time step, in the system of the dynamics.",
    );
    page.head(false);
    page.rows("RepulsionParams", &RepulsionParams::default(), None, all);
    page.section("[solver.sleep]", "Bodies at rest, which take no time.");
    page.head(true);
    let sleep = |preset| bowknot::Scene::with_preset(preset).solver.sleep;
    page.rows(
        "SleepParams",
        &sleep(bowknot::scene::Preset::Fast),
        Some(&sleep(bowknot::scene::Preset::Paper)),
        all,
    );

    page.section("[output]", "What a run writes.");
    page.head(false);
    page.rows("OutputParams", &OutputParams::default(), None, all);

    page.section("[[body]]", "A deformable body; at least one.");
    page.head(false);
    page.rows("BodySpec", &BodySpec::default(), None, all);
    page.section(
        "body.material",
        "A material of the body's kind by name, or a table: `base` names the one that the numbers left out \
         come from (for a cloth `fabric` does as well). The defaults are those of the kind's first \
         material.",
    );
    let names = |kind: BodyKind| {
        let names: Vec<String> = kind.materials().iter().map(|name| format!("`{name}`")).collect();
        format!("\n`kind = \"{}\"`: {}.\n", kind.name(), names.join(", "))
    };
    page.text += &names(BodyKind::Cloth);
    page.head(false);
    page.rows("ClothMaterial", &ClothMaterial::default(), None, all);
    page.text += &names(BodyKind::Solid);
    page.head(false);
    page.rows("SolidMaterial", &SolidMaterial::default(), None, all);
    page.text += &names(BodyKind::Strands);
    page.head(false);
    page.rows("StrandMaterial", &StrandMaterial::default(), None, all);
    page.text += &names(BodyKind::Particles);
    page.head(false);
    page.rows("ParticleMaterial", &ParticleMaterial::default(), None, all);

    page.section(
        "The materials",
        "Their numbers, with four digits, as far as those of a kind differ; all others are the defaults above.",
    );
    for kind in [BodyKind::Cloth, BodyKind::Solid, BodyKind::Strands, BodyKind::Particles] {
        page.text += &shipped_materials(kind);
    }

    page.section("[[obstacle]]", "Something that bodies collide with and that moves only as prescribed.");
    page.head(false);
    page.rows("ObstacleSpec", &ObstacleSpec::default(), None, all);

    page.section("[[pin]]", "Held or led vertices: those of all selectors given.");
    page.head(false);
    page.rows("PinSpec", &PinSpec::default(), None, all);
    page.section("pin.box", "An axis-aligned box of the scene.");
    page.head(false);
    page.rows("Region", &Region::default(), None, all);

    page.section(
        "motion of obstacles and pins",
        "x -> center + R (x - center) + translate, R the rotation about `axis` by `spin` times the time plus \
         the keyframes' `angle`. Without a motion things stay where they are.",
    );
    page.head(false);
    page.rows("Motion", &Motion::default(), None, all);
    page.section("motion.keyframes", "Places to be at given times.");
    page.head(false);
    page.rows("Keyframe", &Keyframe::default(), None, all);

    page.section(
        "shape of bodies and obstacles",
        "A table with the key `type`, or the type's name alone for its defaults. Shapes are about the \
         origin, z up; `scale`, `rotate` and `translate` place them.",
    );
    let _ = write!(page.text, "\n`type = \"sheet\"`: a flat rectangle in the xy plane.\n");
    page.head(false);
    page.rows("Sheet", &Sheet::default(), None, all);
    let _ = write!(page.text, "\n`type = \"tube\"`: an open cylinder along the x axis.\n");
    page.head(false);
    page.rows("Tube", &Tube::default(), None, all);
    let _ = write!(page.text, "\n`type = \"ball\"`: a closed sphere.\n");
    page.head(false);
    page.rows("Ball", &Ball::default(), None, all);
    let _ =
        write!(page.text, "\n`type = \"cone\"`: a closed cone on the xy plane, its tip a single vertex.\n");
    page.head(false);
    page.rows("Cone", &Cone::default(), None, all);
    let _ = write!(page.text, "\n`type = \"box\"`: a closed box.\n");
    page.head(false);
    page.rows("Cuboid", &Cuboid::default(), None, all);
    let _ = write!(
        page.text,
        "\n`type = \"figure\"`: a human figure, 1.7 m tall, that stands at the origin, looks along x, and \
         walks and turns as its keys say; for obstacles only.\n"
    );
    page.head(false);
    page.rows("Figure", &Figure::default(), None, all);
    let _ = write!(
        page.text,
        "\n`type = \"garment\"`: a tube of cloth around the figure as it stands at the start; `scale`, \
         `rotate` and `translate` as those of the figure.\n"
    );
    page.head(false);
    page.rows("Garment", &Garment::default(), None, all);
    let _ =
        write!(page.text, "\n`type = \"wedge\"`: a closed prism with a sharp upper edge, such as a blade.\n");
    page.head(false);
    page.rows("Wedge", &Wedge::default(), None, all);
    let _ = write!(page.text, "\n`type = \"lathe\"`: a surface of revolution about the z axis.\n");
    page.head(false);
    page.rows("Lathe", &Lathe::default(), None, all);
    let _ = write!(page.text, "\n`type = \"ribbon\"`: a strip along a smooth curve.\n");
    page.head(false);
    page.rows("Ribbon", &Ribbon::default(), None, all);
    let _ = write!(
        page.text,
        "\n`type = \"half-space\"`: everything below the plane through `translate`; for obstacles only.\n"
    );
    page.head(false);
    page.rows("HalfSpaceShape", &HalfSpaceShape::default(), None, all);
    let _ = write!(page.text, "\n`type = \"block\"`: a box of tetrahedra, a solid.\n");
    page.head(false);
    page.rows("Block", &Block::default(), None, all);
    let _ = write!(page.text, "\n`type = \"tet-ball\"`: a ball of tetrahedra, a solid.\n");
    page.head(false);
    page.rows("TetBall", &TetBall::default(), None, all);
    let _ = write!(page.text, "\n`type = \"strands\"`: a bundle of strands.\n");
    page.head(false);
    page.rows("Strands", &Strands::default(), None, all);
    let _ = write!(page.text, "\n`type = \"woven\"`: a plain weave of strands.\n");
    page.head(false);
    page.rows("Woven", &Woven::default(), None, all);
    let _ = write!(page.text, "\n`type = \"grains\"`: particles in a box.\n");
    page.head(false);
    page.rows("Grains", &Grains::default(), None, all);
    let _ = write!(
        page.text,
        "\n`type = \"arrays\"`: a mesh by its arrays, for callers that have it in memory. Its elements are those \
         of the body's kind; without any, each point is a particle.\n"
    );
    page.head(false);
    page.rows("MeshArrays", &MeshArrays::default(), None, all);
    page.text
}

/// The keys in which the preset `quick` differs from `fast`, with its values.
fn quick_differences() -> String {
    use bowknot::scene::Preset;
    let table = |preset| -> Table {
        bowknot::Scene::with_preset(preset).to_toml().parse().unwrap_or_else(|error| panic!("{error}"))
    };
    let (fast, quick) = (table(Preset::Fast), table(Preset::Quick));
    let mut differences = Vec::new();
    collect_differences("", &fast, &quick, &mut differences);
    differences.retain(|text| !text.starts_with("`contact.preset"));
    let last = differences.pop().unwrap_or_default();
    format!("{} and {last}", differences.join(", "))
}

fn collect_differences(path: &str, of: &Table, other: &Table, differences: &mut Vec<String>) {
    for (key, value) in other {
        match (of.get(key), value) {
            (Some(Value::Table(of)), Value::Table(value)) => {
                collect_differences(&format!("{path}{key}."), of, value, differences);
            }
            (of, value) if of != Some(value) => differences.push(format!("`{path}{key} = {value}`")),
            _ => {}
        }
    }
}

/// A row per material of a kind: the numbers in which they differ.
fn shipped_materials(kind: BodyKind) -> String {
    let numbers = |name: &&str| -> toml::Table {
        let material = Material::named(kind, name).expect("a material with this name");
        let toml::Value::Table(table) = toml::Value::try_from(material).expect("numbers") else {
            panic!("{name} is no table")
        };
        table
    };
    let tables: Vec<toml::Table> = kind.materials().iter().map(numbers).collect();
    let mut keys: Vec<&String> = tables.iter().flat_map(toml::Table::keys).collect();
    keys.sort_unstable();
    keys.dedup();
    keys.retain(|key| tables.iter().any(|table| table.get(*key) != tables[0].get(*key)));
    let header: Vec<String> = keys.iter().map(|key| format!("`{key}`")).collect();
    let mut text =
        format!("\n| {} | {} |\n|---|{}\n", kind.name(), header.join(" | "), "--:|".repeat(keys.len()));
    for (name, table) in kind.materials().iter().zip(&tables) {
        let cells: Vec<String> =
            keys.iter().map(|key| table.get(*key).map_or_else(String::new, cell)).collect();
        text += &format!("| `{name}` | {} |\n", cells.join(" | "));
    }
    text
}

/// A number with four digits; others as TOML writes them.
fn cell(value: &toml::Value) -> String {
    match value {
        toml::Value::Float(number) => {
            let rounded: f64 = format!("{number:.3e}").parse().expect("a number");
            format!("{rounded:?}")
        }
        other => other.to_string(),
    }
}

fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/scene-reference.md")
}

#[test]
fn the_reference_page_is_up_to_date() {
    let page = page();
    if std::env::var_os("BOWKNOT_ACCEPT").is_some() {
        fs::write(path(), &page).expect("docs/scene-reference.md");
    }
    let stored = fs::read_to_string(path()).unwrap_or_default();
    let first = stored.lines().zip(page.lines()).find(|(a, b)| a != b);
    assert!(
        stored == page,
        "docs/scene-reference.md is stale, first at {first:?}: BOWKNOT_ACCEPT=1 cargo test --release \
         --workspace reference"
    );
}

#[test]
fn every_key_that_a_scene_has_is_on_the_page() {
    let page = page();
    let scene = bowknot::Scene::builtin("tube", 0.1).expect("a scene");
    let table: Table = scene.to_toml().parse().expect("TOML");
    fn keys(value: &Value, found: &mut Vec<String>) {
        match value {
            Value::Table(table) => {
                for (key, value) in table {
                    found.push(key.clone());
                    keys(value, found);
                }
            }
            Value::Array(list) => list.iter().for_each(|value| keys(value, found)),
            _ => {}
        }
    }
    let mut found = Vec::new();
    keys(&Value::Table(table), &mut found);
    assert!(found.len() > 60);
    for key in found {
        let heading = [
            "simulation",
            "contact",
            "friction_pairs",
            "solver",
            "backward",
            "forward",
            "newton",
            "repulsion",
            "sleep",
            "output",
            "body",
            "obstacle",
            "pin",
            "stop",
        ];
        let known =
            heading.contains(&key.as_str()) || page.contains(&format!("| `{key}` |")) || key == "type";
        assert!(known, "{key} is not documented");
    }
}
