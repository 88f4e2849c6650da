//! What JavaScript passes as an object.

use crate::error::{Thrown, input, internal};
use js_sys::{Array, Float64Array, JSON, Object, Reflect, Uint32Array};
use serde::Serialize;
use wasm_bindgen::{JsCast, JsValue};

/// An object with keys, all of which must be known.
pub struct Options {
    object: JsValue,
    /// What the object is for, in messages.
    whole: &'static str,
}

impl Options {
    /// The options of `whole`; `undefined` and `null` stand for none.
    pub fn new(object: &JsValue, whole: &'static str, known: &[&str]) -> Result<Self, Thrown> {
        let is_absent = object.is_undefined() || object.is_null();
        let object = if is_absent { Object::new().into() } else { object.clone() };
        let Some(keys) = object.dyn_ref::<Object>().map(Object::keys) else {
            return Err(input(format!("{whole}: an object is expected")));
        };
        for key in keys.iter().filter_map(|key| key.as_string()) {
            if !known.contains(&key.as_str()) {
                return Err(input(format!("{whole}: unknown key {key}; known are: {}", known.join(", "))));
            }
        }
        Ok(Self { object, whole })
    }

    /// The value of a key, if it has one.
    pub fn get(&self, key: &str) -> Option<JsValue> {
        let value = Reflect::get(&self.object, &key.into()).ok()?;
        (!value.is_undefined() && !value.is_null()).then_some(value)
    }

    fn expected(&self, key: &str, what: &str) -> Thrown {
        input(format!("{}: {key} must be {what}", self.whole))
    }

    /// A list or array of numbers.
    pub fn floats(&self, key: &str) -> Result<Option<Float64Array>, Thrown> {
        let Some(value) = self.get(key) else { return Ok(None) };
        if let Some(list) = value.dyn_ref::<Array>() {
            let numbers: Option<Vec<f64>> = list.iter().map(|entry| entry.as_f64()).collect();
            let numbers =
                numbers.ok_or_else(|| self.expected(key, "an Array of numbers or a Float64Array"))?;
            return Ok(Some(Float64Array::from(numbers.as_slice())));
        }
        if value.is_instance_of::<js_sys::Float32Array>() {
            return Ok(Some(Float64Array::new(&value)));
        }
        value.dyn_into().map(Some).map_err(|_| self.expected(key, "a Float64Array"))
    }

    /// A list or array of indices.
    pub fn indices(&self, key: &str) -> Result<Option<Uint32Array>, Thrown> {
        let Some(value) = self.get(key) else { return Ok(None) };
        if let Some(list) = value.dyn_ref::<Array>() {
            let index = |entry: f64| {
                (entry >= 0.0 && entry.fract() == 0.0 && entry < f64::from(u32::MAX)).then_some(entry as u32)
            };
            let indices: Option<Vec<u32>> = list.iter().map(|entry| entry.as_f64().and_then(index)).collect();
            let indices = indices
                .ok_or_else(|| self.expected(key, "an Array of whole numbers from 0 or a Uint32Array"))?;
            return Ok(Some(Uint32Array::from(indices.as_slice())));
        }
        if value.is_instance_of::<js_sys::Uint16Array>() {
            return Ok(Some(Uint32Array::new(&value)));
        }
        value.dyn_into().map(Some).map_err(|_| self.expected(key, "a Uint32Array"))
    }

    /// A list or array of truth values.
    pub fn flags(&self, key: &str) -> Result<Option<Vec<bool>>, Thrown> {
        let Some(value) = self.get(key) else { return Ok(None) };
        if Array::is_array(&value) || value.is_instance_of::<js_sys::Uint8Array>() {
            return Ok(Some(Array::from(&value).iter().map(|flag| flag.is_truthy()).collect()));
        }
        Err(self.expected(key, "an Array of truth values or a Uint8Array"))
    }

    /// A number, or a list or array of `count` of them; NaN for none.
    pub fn per(&self, key: &str, count: usize) -> Result<Vec<Option<f64>>, Thrown> {
        let given = |value: f64| Some(value).filter(|value| !value.is_nan());
        let Some(value) = self.get(key) else { return Ok(vec![None; count]) };
        if let Some(number) = value.as_f64() {
            return Ok(vec![given(number); count]);
        }
        let values = self.floats(key)?.map(|values| values.to_vec()).unwrap_or_default();
        match values.len() == count {
            true => Ok(values.into_iter().map(given).collect()),
            false => Err(self.expected(key, &format!("a number or {count} of them, not {}", values.len()))),
        }
    }

    /// A number.
    pub fn number(&self, key: &str) -> Result<Option<f64>, Thrown> {
        let number = |value: JsValue| value.as_f64().ok_or_else(|| self.expected(key, "a number"));
        self.get(key).map(number).transpose()
    }

    /// A list of texts.
    pub fn texts(&self, key: &str) -> Result<Vec<String>, Thrown> {
        let Some(value) = self.get(key) else { return Ok(Vec::new()) };
        let refused = || self.expected(key, "a list of texts");
        if !Array::is_array(&value) {
            return Err(refused());
        }
        Array::from(&value).iter().map(|text| text.as_string().ok_or_else(refused)).collect()
    }
}

/// A plain object with the fields of a struct.
pub fn object(value: &impl Serialize) -> Result<JsValue, Thrown> {
    let text = serde_json::to_string(value).map_err(internal)?;
    JSON::parse(&text)
}
