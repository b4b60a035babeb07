//! The built page, which is part of the program.

/// A file of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Asset {
    /// Its name in the folder `assets/` beside the page.
    pub name: &'static str,
    /// Its media type, as a server states it.
    pub media_type: &'static str,
    /// What it holds.
    pub bytes: &'static [u8],
}

/// The page itself, which names its files as `assets/NAME`.
pub const PAGE: &str = include_str!("../page/dist/index.html");

/// The name of the evaluator, WebAssembly packed by LZMA, a third smaller than by gzip; the page unpacks it.
pub(crate) const CORE: &str = "core.wasm.lzma";
/// The name of the readers of all formats, which the page fetches when a file needs them.
pub(crate) const READERS: &str = "readers.wasm.lzma";
/// The name of the program of the page.
pub(crate) const PROGRAM: &str = "page.js";

const ASSETS: [Asset; 3] = [
    Asset {
        name: PROGRAM,
        media_type: "text/javascript; charset=utf-8",
        bytes: include_bytes!("../page/dist/assets/page.js"),
    },
    Asset {
        name: CORE,
        media_type: "application/octet-stream",
        bytes: include_bytes!("../page/dist/assets/core.wasm.lzma"),
    },
    Asset {
        name: READERS,
        media_type: "application/octet-stream",
        bytes: include_bytes!("../page/dist/assets/readers.wasm.lzma"),
    },
];

/// All files of the page beside [`PAGE`].
#[must_use]
pub fn assets() -> &'static [Asset] {
    &ASSETS
}

/// A file of the page by its exact name.
///
/// ```
/// assert!(condyle_view::asset("page.js").is_some());
/// assert!(condyle_view::asset("../session.json").is_none());
/// ```
#[must_use]
pub fn asset(name: &str) -> Option<&'static Asset> {
    ASSETS.iter().find(|asset| asset.name == name)
}
