"""A folder as an archive and its checksum: archive.py FOLDER ARCHIVE.tar.gz DATE. The same files give the same bytes on every system: they
stand in the order of their names, of one date (in seconds since 1970) and of nobody."""

import gzip
import hashlib
import os
import sys
import tarfile
from pathlib import Path


def main(folder: Path, archive: Path, date: int) -> None:
    def plain(entry: tarfile.TarInfo) -> tarfile.TarInfo:
        # An archive made on Windows, whose files have no such mark, is unpacked there too.
        program = os.access(folder.parent / entry.name, os.X_OK)
        entry.uid, entry.gid, entry.uname, entry.gname, entry.mtime = 0, 0, "", "", date
        entry.mode = 0o755 if program else 0o644
        return entry

    with open(archive, "wb") as file, gzip.GzipFile("", "wb", 9, file, 0) as packed:
        with tarfile.open(fileobj=packed, mode="w", format=tarfile.USTAR_FORMAT) as entries:
            for path in sorted(path for path in folder.rglob("*") if path.is_file()):
                entries.add(path, path.relative_to(folder.parent).as_posix(), filter=plain)
    checksum = f"{hashlib.sha256(archive.read_bytes()).hexdigest()}  {archive.name}"
    archive.with_name(f"{archive.name}.sha256").write_text(f"{checksum}\n", encoding="ascii", newline="\n")
    print(checksum)


main(Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]))
