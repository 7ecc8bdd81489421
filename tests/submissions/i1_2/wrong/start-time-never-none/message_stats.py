import time
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

# サブスクライバーノード
class MessageStatsNode(Node):
    # 初期化
    def __init__(self):
        super().__init__("message_stats_node")

        # 統計データ
        self.total_count = 0
        self.first_message = ""
        self.last_message = ""
        self.start_time = 0.0
        self.messages_per_second = 0.0
        self.last_number = -1

        # サブスクライバーの生成
        self.subscription = self.create_subscription(
            String, "chatter", self.on_subscribe, 10
        )

    # サブスクライブ時に呼ばれる
    def on_subscribe(self, msg):
        # 最初のメッセージの時刻
        if self.start_time is None:
            self.start_time = time.time()

        if self.total_count == 0:
            self.first_message = msg.data
        self.last_message = msg.data
        self.total_count += 1

        # 1秒あたりのメッセージ数
        elapsed = time.time() - self.start_time
        if elapsed > 0:
            self.messages_per_second = self.total_count / elapsed

        self.check_number(int(msg.data.split(":")[1]))

        # 10回ごとにログ出力
        if self.total_count % 10 == 0:
            self.get_logger().info("合計 : " + str(self.total_count)
                + ", レート : " + f"{self.messages_per_second:.2f}" + " msg/s"
                + ", 最初 : " + self.first_message + ", 最後 : " + self.last_message)

    # 番号の確認
    def check_number(self, number):
        if self.last_number >= 0:
            if number < self.last_number:
                self.get_logger().warn("パブリッシャーが再起動しました (restart)")
            elif number > self.last_number + 1:
                self.get_logger().warn("番号が飛びました gap : " + str(self.last_number) + " -> " + str(number))
        self.last_number = number

def main(args=None):
    # RCLの初期化
    rclpy.init(args=args)

    # ノードの生成
    node = MessageStatsNode()

    # ノード終了まで待機
    rclpy.spin(node)

    # ノードの破棄
    node.destroy_node()

    # RCLのシャットダウン
    rclpy.shutdown()

if __name__ == "__main__":
    main()
