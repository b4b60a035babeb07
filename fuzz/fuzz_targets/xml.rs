//! Any bytes as XML: no panic, and a tree whose elements are all reached, once, in order.
#![no_main]

use condyle_formats::XmlDocument;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    let Ok(read) = XmlDocument::from_bytes(data) else { return };
    let root = read.value.root();
    assert_eq!(root.descendants().count(), read.value.elements());
    let mut before = None;
    for element in root.descendants() {
        let byte = element.place().byte;
        assert!(before < Some(byte), "elements come in the order of the file");
        before = Some(byte);
        assert!(element.children().all(|child| child.parent() == Some(element)));
        let below: usize = element.children().map(|child| child.descendants().count()).sum();
        assert_eq!(element.descendants().count(), below + 1);
        let _ = (element.f64(), element.f64s(), element.bool(), element.numbers::<3>());
        let _ = element.require_attribute("name");
    }
});
