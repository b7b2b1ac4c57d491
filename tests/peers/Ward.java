/* SPDX-License-Identifier: MIT
 *
 * Ward X Y OUT.pfm - a ball of Ward's metal under a point light, by Sunflow: X
 * and Y are alphas along and across circles around the y axis. Its program asks
 * for them the other way round. */
import java.io.DataOutputStream;
import java.io.FileOutputStream;
import java.nio.ByteBuffer;
import java.nio.ByteOrder;
import org.sunflow.SunflowAPI;
import org.sunflow.core.Display;
import org.sunflow.image.Color;
import org.sunflow.math.Matrix4;
import org.sunflow.math.Point3;
import org.sunflow.math.Vector3;

public class Ward implements Display {
    static final int SIDE = 256;
    final float[] rgb = new float[3 * SIDE * SIDE];

    public void imageBegin(int w, int h, int bucket) {}
    public void imagePrepare(int x, int y, int w, int h, int id) {}
    public void imageEnd() {}

    public void imageFill(int x, int y, int w, int h, Color c, float alpha) {
        Color[] all = new Color[w * h];

        java.util.Arrays.fill(all, c);
        imageUpdate(x, y, w, h, all, null);
    }

    public void imageUpdate(int x, int y, int w, int h, Color[] c, float[] alpha) {
        for (int i = 0; i < w * h; i++)
            System.arraycopy(c[i].getRGB(), 0, rgb,
                             3 * ((SIDE - 1 - y - i / w) * SIDE + x + i % w), 3);
    }

    static SunflowAPI scene(float x, float y) {
        SunflowAPI api = new SunflowAPI();

        api.parameter("eye", new Point3(0, 0, 4));
        api.parameter("transform", Matrix4.lookAt(new Point3(0, 0, 4), new Point3(0, 0, 0), new Vector3(0, 1, 0)));
        api.parameter("fov", 53f);
        api.parameter("aspect", 1f);
        api.camera("camera", "pinhole");
        api.parameter("diffuse", null, 0f, 0f, 0f);
        api.parameter("specular", null, .2f, .2f, .2f);
        api.parameter("roughnessX", y);
        api.parameter("roughnessY", x);
        api.parameter("samples", 0);
        api.shader("metal", "ward");
        api.geometry("ball", "sphere");
        api.parameter("shaders", new String[] {"metal"});
        api.parameter("transform", Matrix4.rotateX(-(float) Math.PI / 2).multiply(Matrix4.scale(1.2f)));
        api.instance("ball.instance", "ball");
        float power = 6 * 4 * (float) Math.PI;
        api.parameter("center", new Point3(2, 3, 4));
        api.parameter("power", null, power, power, power);
        api.light("lamp", "point");
        api.parameter("camera", "camera");
        api.parameter("resolutionX", SIDE);
        api.parameter("resolutionY", SIDE);
        api.parameter("aa.min", 2);
        api.parameter("aa.max", 2);
        api.parameter("filter", "box");
        api.options(SunflowAPI.DEFAULT_OPTIONS);
        return api;
    }

    public static void main(String[] args) throws Exception {
        Ward seen = new Ward();

        scene(Float.parseFloat(args[0]), Float.parseFloat(args[1]))
            .render(SunflowAPI.DEFAULT_OPTIONS, seen);
        ByteBuffer bytes = ByteBuffer.allocate(4 * seen.rgb.length).order(ByteOrder.LITTLE_ENDIAN);
        for (float v : seen.rgb)
            bytes.putFloat(v);
        try (DataOutputStream out = new DataOutputStream(new FileOutputStream(args[2]))) {
            out.writeBytes("PF\n" + SIDE + " " + SIDE + "\n-1\n");
            out.write(bytes.array());
        }
    }
}
