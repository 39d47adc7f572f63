//! One file of Parquet: columns that grow in memory, and are written in groups of rows.

use std::fs::File;
use std::sync::Arc;

use parquet::basic::{Compression, GzipLevel};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, FloatType, Int32Type, Int64Type};
use parquet::errors::{ParquetError, Result};
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedColumnWriter, SerializedFileWriter};
use parquet::schema::parser::parse_message_type;
use unipbd_core::observe::Value;

/// Rows after which a group is written.
const GROUP: usize = 1 << 20;

/// The values of a column that are not written yet.
#[derive(Clone)]
pub(super) enum Column {
    Long(Vec<i64>),
    Id(Vec<i32>),
    Float(Vec<f32>),
    Double(Vec<f64>),
    Text(Vec<ByteArray>),
}

/// A value of a column of the same kind.
pub(super) enum Cell {
    Long(u64),
    Id(u32),
    Float(f32),
    Double(f64),
    Text(ByteArray),
}

impl Cell {
    /// A single column of the diagnostics.
    pub fn of(value: Value<'_>) -> Cell {
        match value {
            Value::Count(count) => Cell::Long(count),
            Value::Word(word) => Cell::Text(word.into()),
            single => Cell::Double(single.number().unwrap_or(f64::NAN)),
        }
    }
}

impl Column {
    pub fn of(value: &Value<'_>) -> Column {
        match value {
            Value::Count(_) => Column::Long(Vec::new()),
            Value::Word(_) => Column::Text(Vec::new()),
            _ => Column::Double(Vec::new()),
        }
    }

    /// Its type in the language of schemas.
    fn kind(&self) -> [&'static str; 2] {
        match self {
            Column::Long(_) => ["INT64", ""],
            Column::Id(_) => ["INT32", "(INTEGER(32,false))"],
            Column::Float(_) => ["FLOAT", ""],
            Column::Double(_) => ["DOUBLE", ""],
            Column::Text(_) => ["BYTE_ARRAY", "(UTF8)"],
        }
    }

    fn put(&mut self, cell: Cell) -> Result<()> {
        match (self, cell) {
            (Column::Long(values), Cell::Long(value)) => values.push(i64::try_from(value).unwrap_or(i64::MAX)),
            // Unsigned, in the bits of a signed number.
            (Column::Id(values), Cell::Id(value)) => values.push(value.cast_signed()),
            (Column::Float(values), Cell::Float(value)) => values.push(value),
            (Column::Double(values), Cell::Double(value)) => values.push(value),
            (Column::Text(values), Cell::Text(value)) => values.push(value),
            _ => return Err(ParquetError::General("a column has values of two kinds".to_owned())),
        }
        Ok(())
    }

    /// Writes and forgets the values.
    fn write(&mut self, to: &mut SerializedColumnWriter<'_>) -> Result<()> {
        match self {
            Column::Long(values) => to.typed::<Int64Type>().write_batch(values, None, None).map(|_| values.clear()),
            Column::Id(values) => to.typed::<Int32Type>().write_batch(values, None, None).map(|_| values.clear()),
            Column::Float(values) => to.typed::<FloatType>().write_batch(values, None, None).map(|_| values.clear()),
            Column::Double(values) => to.typed::<DoubleType>().write_batch(values, None, None).map(|_| values.clear()),
            Column::Text(values) => to.typed::<ByteArrayType>().write_batch(values, None, None).map(|_| values.clear()),
        }
    }
}

/// A table on its way into a file.
pub(super) struct Sheet {
    writer: SerializedFileWriter<File>,
    columns: Vec<Column>,
    rows: usize,
}

/// The cells of a row, from the left.
pub(super) struct Cells<'a>(std::slice::IterMut<'a, Column>);

impl Cells<'_> {
    pub fn put(&mut self, cell: Cell) -> Result<()> {
        let column = self.0.next().ok_or_else(|| ParquetError::General("a row is too long".to_owned()))?;
        column.put(cell)
    }
}

impl Sheet {
    pub fn new(file: File, columns: Vec<(String, Column)>) -> Result<Sheet> {
        let fields = columns.iter().map(|(name, column)| {
            let [kind, logical] = column.kind();
            format!("REQUIRED {kind} {name} {logical};")
        });
        let schema = parse_message_type(&format!("message table {{ {} }}", fields.collect::<String>()))?;
        let properties = WriterProperties::builder().set_compression(Compression::GZIP(GzipLevel::try_new(1)?));
        let properties = properties.set_created_by(concat!("unipbd ", env!("CARGO_PKG_VERSION")).to_owned()).build();
        let writer = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))?;
        Ok(Sheet { writer, columns: columns.into_iter().map(|(_, column)| column).collect(), rows: 0 })
    }

    pub fn cells(&mut self) -> Cells<'_> {
        Cells(self.columns.iter_mut())
    }

    pub fn add(&mut self, row: impl Iterator<Item = Cell>) -> Result<()> {
        let mut cells = self.cells();
        row.into_iter().try_for_each(|cell| cells.put(cell))?;
        self.end_row()
    }

    pub fn end_row(&mut self) -> Result<()> {
        self.rows += 1;
        if self.rows == GROUP { self.write_group() } else { Ok(()) }
    }

    fn write_group(&mut self) -> Result<()> {
        let mut group = self.writer.next_row_group()?;
        for column in &mut self.columns {
            let Some(mut writer) = group.next_column()? else { break };
            column.write(&mut writer)?;
            writer.close()?;
        }
        group.close()?;
        self.rows = 0;
        Ok(())
    }

    pub fn finish(mut self) -> Result<()> {
        if self.rows > 0 {
            self.write_group()?;
        }
        self.writer.close().map(|_| ())
    }
}
