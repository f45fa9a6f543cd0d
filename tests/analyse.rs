//! `bowling analyse` and `bowling power`: the real program on tables and on what it cannot use.

use serde_json::Value;

use crate::support::{bowling, fresh_folder};

const STUDY_OF_1997: &str =
    "crates/experiment/tests/data/statistics/01a_uno_slater_reconstructed.csv";

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn study_of_1997_comes_out_as_printed() {
    let folder = fresh_folder("analyse-1997");
    let out = folder.to_str().unwrap();
    let run = bowling(&[
        "analyse",
        STUDY_OF_1997,
        "--out",
        out,
        "--randomisations",
        "500",
    ]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let said = text(&run.stdout);
    for line in [
        "  %      28  28  17  0  17  6  6        18",
        "  no change observed           3         0      6",
        "  elasticity         Const. - 0.7*sick + 2.1*F",
        "  friction           Const. - 0.7*sick + 3.8*S - 3.8*E",
        "  shape              Const. - 0.7*sick + 2.1*F",
        "chi-squared = 12.727, d.f. = 8; tabulated chi-squared = 13.362 for P = 0.10",
        "  change(2).E    -3.836   1.446            1.442",
        "  change(3).E   -0.5274   1.119            1.115",
        "No coefficient reaches 5 %",
        "Fisher-Freeman-Halton exact test of all parameters together: P = 0.002468",
    ] {
        assert!(said.contains(line), "not in the report: {line}\n{said}");
    }
    let page = std::fs::read_to_string(folder.join("report.html")).unwrap();
    assert!(page.matches("<svg").count() == 3 && page.contains("</html>"));
    for outside in ["src=", "href=", "@import", "url("] {
        assert!(
            !page.contains(outside),
            "the page fetches something: {outside}"
        );
    }
    let json: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.join("report.json")).unwrap())
            .unwrap();
    assert!((json["gof"]["deviance"].as_f64().unwrap() - 12.726_636_090_526_6).abs() < 1e-9);
    assert_eq!(json["randomisation"]["tried"], 500);
    for figure in ["answers", "coefficients", "noticed"] {
        assert!(folder.join(format!("{figure}.svg")).is_file(), "{figure}");
    }
}

/// Sums and counts from the table, by hand: changed, held, subjects, high answers of six each.
const CONDITIONS: [(&str, &str, u32, f64); 12] = [
    ("elasticity", "F0 S0", 2, 1.0),
    ("elasticity", "F0 S1", 1, 1.0),
    ("elasticity", "F1 S0", 1, 3.0),
    ("elasticity", "F1 S1", 2, 5.0),
    ("friction", "E0 S0", 2, 1.0),
    ("friction", "E0 S1", 1, 4.0),
    ("friction", "E1 S0", 1, 0.0),
    ("friction", "E1 S1", 2, 1.0),
    ("shape", "E0 F0", 2, 4.0),
    ("shape", "E0 F1", 1, 0.0),
    ("shape", "E1 F0", 1, 0.0),
    ("shape", "E1 F1", 2, 7.0),
];

#[test]
fn answers_are_told_and_drawn_by_condition() {
    let folder = fresh_folder("analyse-conditions");
    let out = folder.to_str().unwrap();
    let few = ["--randomisations", "100"];
    let run = bowling(&[&["analyse", STUDY_OF_1997, "--out", out], &few[..]].concat());
    assert!(run.status.success(), "{}", text(&run.stderr));
    let report = std::fs::read_to_string(folder.join("report.json")).unwrap();
    let report: Value = serde_json::from_str(&report).unwrap();
    let told = report["answers_by_condition"].as_array().unwrap();
    assert_eq!(told.len(), CONDITIONS.len());
    for (one, (changed, held, subjects, high)) in told.iter().zip(CONDITIONS) {
        assert_eq!(
            (&one["changed"], &one["held"]),
            (&changed.into(), &held.into())
        );
        assert_eq!(one["subjects"], subjects);
        let mean = one["mean_share_of_high_answers"].as_f64().unwrap();
        assert!(
            (mean - high / 6.0 / f64::from(subjects)).abs() < 1e-12,
            "{one}"
        );
    }
    let drawn = std::fs::read_to_string(folder.join("answers.svg")).unwrap();
    for (_, held, subjects, _) in CONDITIONS {
        assert!(drawn.contains(&format!("{held} ({subjects})")), "{held}");
    }
    // 11 of 36 high answers.
    assert!(drawn.contains("shape changed: 0.31"), "{drawn}");
}

#[test]
fn same_input_gives_the_same_bytes() {
    let folders = ["analyse-once", "analyse-again"].map(fresh_folder);
    for folder in &folders {
        let run = bowling(&[
            "analyse",
            STUDY_OF_1997,
            "--out",
            folder.to_str().unwrap(),
            "--randomisations",
            "200",
            "--json",
        ]);
        assert!(
            run.status.success() && run.stdout.starts_with(b"{"),
            "{}",
            text(&run.stderr)
        );
    }
    for name in ["report.json", "report.html", "report.txt"] {
        let [once, again] = folders
            .each_ref()
            .map(|folder| std::fs::read(folder.join(name)).unwrap());
        assert!(once == again, "{name}");
    }
}

#[test]
fn what_is_missing_or_infinite_is_said() {
    let folder = fresh_folder("analyse-words");
    let report = |name: &str| {
        let path = format!("crates/experiment/tests/data/statistics/{name}.csv");
        let run = bowling(&[
            "analyse",
            &path,
            "--out",
            folder.to_str().unwrap(),
            "--randomisations",
            "100",
        ]);
        assert!(run.status.success(), "{name}: {}", text(&run.stderr));
        text(&run.stdout)
    };
    let said = report("10_missing_items");
    assert!(said.contains("Left out: sub-0006, because no presence item was answered."));
    assert!(said.contains("Left out: sub-0012, because sick is missing."));
    assert!(report("09a_aliased_vr_all_no").contains("left out of every fit: vr."));
    let said = report("05_quasi_separation");
    assert!(said.contains("Goes to +infinity: change(2).S."));
    let row = said
        .lines()
        .find(|line| line.starts_with("  change(2).S"))
        .unwrap();
    assert!(
        row.contains("+Inf") && row.matches(" - ").count() >= 3,
        "{row}"
    );
    assert!(report("06_all_zero").contains("Separation: complete."));
}

#[test]
fn what_cannot_be_used_is_refused_by_row_and_column() {
    let folder = fresh_folder("analyse-bad");
    let table = folder.join("bad.csv");
    let refused = |content: &str, more: &[&str]| {
        std::fs::write(&table, content).unwrap();
        let mut arguments = vec![
            "analyse",
            table.to_str().unwrap(),
            "--out",
            folder.to_str().unwrap(),
        ];
        arguments.extend(more);
        let run = bowling(&arguments);
        assert!(!run.status.success(), "{content}");
        let said = text(&run.stderr);
        assert_eq!(
            said.trim_end().lines().count().min(2),
            if run.status.code() == Some(1) { 1 } else { 2 },
            "{said}"
        );
        said
    };
    let head = "id,change,E,F,S,sick,vr,y,n\n";
    let said = refused(
        &format!("{head}a,1,0,0,0,2,yes,1,6\nb,1,0,0,0,2,perhaps,1,6\n"),
        &[],
    );
    assert!(
        said.contains("bad.csv, line 3, column vr: \"perhaps\" is not yes or no, nor 1 or 0"),
        "{said}"
    );
    let said = refused(&format!("{head}a,1,0,0,0,9,1,1,6\n"), &[]);
    assert!(
        said.contains("line 2, column sick: \"9\" is not a whole number from 1 to 7"),
        "{said}"
    );
    let said = refused(
        &format!("{head}a,1,0,0,0,2,1,1,6\n"),
        &["--model", "1 + age"],
    );
    assert!(
        said.contains("no column \"age\", which the model names"),
        "{said}"
    );
    let said = refused(head, &[]);
    assert!(
        said.contains("there is no row below the header line"),
        "{said}"
    );
    let said = refused("y,n\n1,6\n", &["--model", "1 + "]);
    assert!(
        said.contains("the model \"1 +\" has an empty term"),
        "{said}"
    );
    let run = bowling(&[
        "analyse",
        "no-such-study",
        "--out",
        folder.to_str().unwrap(),
    ]);
    assert!(!run.status.success() && text(&run.stderr).contains("cannot read no-such-study"));
}

#[test]
fn power_gives_a_curve_and_advice() {
    let folder = fresh_folder("power");
    let out = folder.to_str().unwrap();
    let run = bowling(&[
        "power",
        "--subjects",
        "18,54",
        "--studies",
        "100",
        "--out",
        out,
    ]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    let said = text(&run.stdout);
    assert!(
        said.contains("Type I error of the paper's chi-squared test")
            && said.contains("72 subjects at least"),
        "{said}"
    );
    let json: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.join("power.json")).unwrap()).unwrap();
    let power = |i: usize| {
        json["power"][i]["tests"]["physics(F,S,E)"]["quasi_f"]["power"]
            .as_f64()
            .unwrap()
    };
    assert!(power(0) < power(1) && power(1) > 0.9, "{json}");
    assert!(
        std::fs::read_to_string(folder.join("power.svg"))
            .unwrap()
            .starts_with("<svg")
    );
    let run = bowling(&["power", "--per-game", "--studies", "200", "--out", out]);
    assert!(
        text(&run.stdout).contains("takes 8 subjects per changed parameter, 24 in all"),
        "{}",
        text(&run.stdout)
    );
    let run = bowling(&["power", "--subjects", "3", "--out", out]);
    assert_eq!(run.status.code(), Some(2));
}
