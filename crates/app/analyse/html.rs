//! A report as a page that stands alone: figures inside, nothing fetched.

use super::report::{Block, Table};

/// Its look, which follows the reader's choice of light or dark.
const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:62rem;margin:2rem auto;padding:0 1rem;color:#222;background:#fff}\
h1{font-size:1.5rem}h2{font-size:1.25rem;margin-top:2.5rem;border-bottom:1px solid #999}\
.wide{overflow-x:auto}table{border-collapse:collapse;margin:1.2rem 0;font-variant-numeric:tabular-nums}\
caption{text-align:left;font-weight:600;padding-bottom:.3rem}\
th,td{padding:.15rem .7rem;text-align:right;white-space:nowrap}th:first-child,td:first-child{text-align:left;padding-left:0}\
thead th{border-bottom:1px solid #666;font-weight:600}tbody th{font-weight:400}\
figure{margin:1.5rem 0;overflow-x:auto}figure svg{max-width:100%;height:auto;background:#fff}\
@media(prefers-color-scheme:dark){body{color:#ddd;background:#181818}}";

/// The page: blocks, and the figures that they name.
pub fn page(title: &str, blocks: &[Block], figures: &[(&'static str, String, String)]) -> String {
    let mut body = String::new();
    let mut is_first = true;
    for block in blocks {
        match block {
            Block::Heading(heading) => {
                let level = if is_first { 1 } else { 2 };
                body += &format!("<h{level}>{}</h{level}>\n", escaped(heading));
                is_first = false;
            }
            Block::Text(words) => body += &format!("<p>{}</p>\n", escaped(words)),
            Block::Table(table) => body += &table_of(table),
            Block::Figure(name) => {
                for (_, caption, svg) in figures.iter().filter(|(own, ..)| own == name) {
                    let caption = escaped(caption);
                    body += &format!(
                        "<figure role=\"img\" aria-label=\"{caption}\">{svg}<figcaption>{caption}</figcaption></figure>\n"
                    );
                }
            }
        }
    }
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>{}</title>\n<style>{STYLE}</style>\n</head>\n\
         <body>\n{body}</body>\n</html>\n",
        escaped(title)
    )
}

fn table_of(table: &Table) -> String {
    let mut text = format!(
        "<div class=\"wide\"><table>\n<caption>{}</caption>\n<thead><tr>",
        escaped(&table.caption)
    );
    for name in &table.header {
        text += &format!("<th scope=\"col\">{}</th>", escaped(name));
    }
    text += "</tr></thead>\n<tbody>\n";
    for row in &table.rows {
        text += "<tr>";
        for (column, cell) in row.iter().enumerate() {
            text += &match column {
                0 => format!("<th scope=\"row\">{}</th>", escaped(cell)),
                _ => format!("<td>{}</td>", escaped(cell)),
            };
        }
        text += "</tr>\n";
    }
    text + "</tbody>\n</table></div>\n"
}

/// Text that may stand in a page: what subjects wrote is shown, never obeyed.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn page_escapes_what_subjects_wrote_and_fetches_nothing() {
        let mut table = Table::new("said", &["noticed"]);
        table
            .rows
            .push(vec!["<script>alert(\"1\")</script>".to_owned()]);
        let figures = [("answers", "Answers".to_owned(), "<svg></svg>".to_owned())];
        let page = page(
            "A & B",
            &[Block::Table(table), Block::Figure("answers")],
            &figures,
        );
        assert!(!page.contains("<script") && page.contains("&lt;script&gt;alert(&quot;1&quot;)"));
        assert!(page.contains("<title>A &amp; B</title>") && page.contains("<svg></svg>"));
        for outside in ["http:", "https:", "src=", "@import", "url("] {
            assert!(!page.contains(outside), "{outside}");
        }
    }
}
