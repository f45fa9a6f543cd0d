//! Journals: files of JSON lines that are only ever appended to, and that tell by themselves whether they are whole.
//!
//! A line is one JSON object with two keys before its content: `line`, counted from 1, and `check`, the CRC-32 of all
//! contents so far. A line that is missing, moved or changed is named when the journal is read; a last line that a crash
//! cut short is set aside. The first line's content is `{"header":{"schema":..,"program":..}}`.

mod append;
mod lines;

use std::path::PathBuf;

pub use append::Appender;
pub use lines::{LineProblem, Lines, Torn};

/// Version of the lines' meaning that this program writes.
pub const SCHEMA: u32 = 3;
/// Oldest version that is still read; before version 3 lines were checked by FNV-1a.
pub const OLDEST_SCHEMA: u32 = 2;

/// Why a journal cannot be written.
#[derive(Debug, Clone, thiserror::Error)]
pub enum JournalError {
    /// It cannot be created.
    #[error("cannot create the journal {}: {problem}", .path.display())]
    Create {
        /// The journal.
        path: PathBuf,
        /// What the system says.
        problem: String,
    },
    /// It cannot be written any more.
    #[error("cannot write the journal {}: is the disk full? ({problem})", .path.display())]
    Write {
        /// The journal.
        path: PathBuf,
        /// What the system says.
        problem: String,
    },
}

/// The running check over all lines' contents so far. It finds damage and hand edits; it is no signature.
#[derive(Debug, Clone)]
enum Check {
    /// CRC-32 of IEEE 802.3.
    Crc(crc32fast::Hasher),
    /// FNV-1a, 32 bits: journals before version 3.
    Fnv(u32),
}

impl Check {
    fn of_schema(schema: u32) -> Self {
        if schema < SCHEMA {
            // FNV's offset basis.
            Self::Fnv(0x811c_9dc5)
        } else {
            Self::Crc(crc32fast::Hasher::new())
        }
    }

    /// The check up to and with `content`.
    fn go_on(&mut self, content: &[u8]) -> u32 {
        match self {
            Self::Crc(hasher) => {
                hasher.update(content);
                hasher.clone().finalize()
            }
            Self::Fnv(hash) => {
                for byte in content {
                    *hash = (*hash ^ u32::from(*byte)).wrapping_mul(0x0100_0193);
                }
                *hash
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checks_agree_with_the_published_values() {
        // The catalogue of parametrised CRC algorithms gives cbf43926 for "123456789" under CRC-32/ISO-HDLC.
        let mut crc = Check::of_schema(3);
        crc.go_on(b"1234");
        assert_eq!(crc.go_on(b"56789"), 0xcbf4_3926);
        // FNV-1a test vectors by Landon Curt Noll: "foobar" hashes to bf9cf968.
        let mut fnv = Check::of_schema(2);
        fnv.go_on(b"foo");
        assert_eq!(fnv.go_on(b"bar"), 0xbf9c_f968);
    }
}
