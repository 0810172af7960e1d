import { useEffect, useRef, useState } from "react";

/** Lets files be dropped anywhere on the page, and says so while one hovers. */
export function DropTarget({ onFile }: { onFile: (file: File) => void }) {
  const [hovering, setHovering] = useState(false);
  const depth = useRef(0);
  const receive = useRef(onFile);
  useEffect(() => {
    receive.current = onFile;
  }, [onFile]);

  useEffect(() => {
    const carriesFiles = (event: DragEvent) => event.dataTransfer?.types.includes("Files") ?? false;
    const enter = (event: DragEvent) => {
      if (!carriesFiles(event)) return;
      event.preventDefault();
      depth.current += 1; // enter and leave fire for every element on the way
      setHovering(true);
    };
    const over = (event: DragEvent) => {
      if (carriesFiles(event)) event.preventDefault();
    };
    const leave = (event: DragEvent) => {
      if (!carriesFiles(event)) return;
      depth.current = Math.max(0, depth.current - 1);
      if (depth.current === 0) setHovering(false);
    };
    const drop = (event: DragEvent) => {
      if (!carriesFiles(event)) return;
      event.preventDefault();
      depth.current = 0;
      setHovering(false);
      for (const file of event.dataTransfer?.files ?? []) receive.current(file);
    };
    window.addEventListener("dragenter", enter);
    window.addEventListener("dragover", over);
    window.addEventListener("dragleave", leave);
    window.addEventListener("drop", drop);
    return () => {
      window.removeEventListener("dragenter", enter);
      window.removeEventListener("dragover", over);
      window.removeEventListener("dragleave", leave);
      window.removeEventListener("drop", drop);
    };
  }, []);

  return hovering ? (
    <div className="drop-veil" aria-hidden="true">
      <div>
        Drop to upload
        <span>OBJ, OFF, PLY, STL or GLB mesh; PLY, XYZ, PCD or LAS point cloud</span>
      </div>
    </div>
  ) : null;
}
